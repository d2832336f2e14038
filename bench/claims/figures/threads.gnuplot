picture = ARG2
load system("dirname ".ARG0)."/style.gnuplot"
set style fill solid 0.9 noborder
set boxwidth 0.6
set yrange [0:2.2]
set xtics rotate by 30 right noenhanced
set ylabel "times the speed of one thread"
plot ARG1 using 0:"times":xticlabels(1) notitle with boxes linecolor rgb sky, \
    ARG1 using 0:"times":"times_low":"times_high" notitle with yerrorbars pointtype 0 linewidth 1.5 linecolor rgb "#1c2733", \
    2 notitle linecolor rgb gray dashtype 2
