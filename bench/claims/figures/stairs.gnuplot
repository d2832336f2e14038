picture = ARG2
load system("dirname ".ARG0)."/style.gnuplot"
set xtics rotate by 30 right noenhanced
set ylabel "operations left"
set yrange [0:*]
plot ARG1 using 0:"specialize":xticlabels(1) title "all passes" with steps linewidth 2 linecolor rgb green, \
    ARG1 using 0:"thesis" title "the thesis' passes" with steps linewidth 2 linecolor rgb sky
