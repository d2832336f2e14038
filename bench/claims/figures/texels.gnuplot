picture = ARG2
load system("dirname ".ARG0)."/style.gnuplot"
set style data histograms
set style histogram clustered gap 1
set style fill solid 0.9 noborder
set yrange [0:*]
set xlabel "degrees"
set ylabel "cache lines for 1000 texels"
plot ARG1 using "rows":xticlabels(1) title "rows" linecolor rgb sky, ARG1 using "tiles" title "tiles of 4 x 4" linecolor rgb green
