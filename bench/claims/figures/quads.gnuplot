picture = ARG2
load system("dirname ".ARG0)."/style.gnuplot"
set style data histograms
set style histogram clustered gap 1
set style fill solid 0.9 noborder
set yrange [0:*]
set ylabel "gain, times"
plot ARG1 using "x2":xticlabels(1) title "4 lanes, two registers" linecolor rgb sky, \
    ARG1 using "x4" title "4 lanes, four registers" linecolor rgb green, \
    ARG1 using "wide" title "8 lanes, two registers" linecolor rgb orange, 1 notitle linecolor rgb gray dashtype 2
