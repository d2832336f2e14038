picture = ARG2
load system("dirname ".ARG0)."/style.gnuplot"
set style data histograms
set style histogram clustered gap 1
set style fill solid 0.9 noborder
set xtics rotate by 30 right noenhanced
set yrange [0:*]
set ylabel "times the speed of emulate"
plot ARG1 using "l4":xticlabels(1) title "4 lanes" linecolor rgb sky, \
    ARG1 using "l8" title "8 lanes" linecolor rgb green, \
    ARG1 using "widest" title "the most lanes here" linecolor rgb orange
