picture = ARG2
load system("dirname ".ARG0)."/style.gnuplot"
set style data histograms
set style histogram clustered gap 1
set style fill solid 0.9 noborder
set xtics rotate by 30 right noenhanced
set yrange [0:*]
set ylabel "time, all registers are 1"
plot ARG1 using "r4":xticlabels(1) title "4 registers" linecolor rgb sky, \
    ARG1 using "r6" title "6 registers" linecolor rgb green, \
    ARG1 using "r8" title "8 registers" linecolor rgb orange, \
    ARG1 using "r12" title "12 registers" linecolor rgb red, \
    1 notitle linecolor rgb "#1c2733" dashtype 2
