picture = ARG2
load system("dirname ".ARG0)."/style.gnuplot"
set style data histograms
set style histogram clustered gap 1
set style fill solid 0.9 noborder
set xtics rotate by 30 right noenhanced
set yrange [0:*]
set ylabel "time, all passes are 1"
plot ARG1 using "invariant":xticlabels(1) title "without invariant" linecolor rgb sky, \
    ARG1 using "common" title "without common" linecolor rgb green, \
    ARG1 using "fold" title "without fold" linecolor rgb orange, \
    ARG1 using "dead" title "without dead" linecolor rgb red, \
    ARG1 using "phi" title "without phi" linecolor rgb purple, \
    ARG1 using "none" title "no pass" linecolor rgb gray, \
    1 notitle linecolor rgb "#1c2733" dashtype 2
