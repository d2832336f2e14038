picture = ARG2
load system("dirname ".ARG0)."/style.gnuplot"
set style data histograms
set style histogram clustered gap 1
set style fill solid 0.9 noborder
set yrange [0:*]
set ylabel "time, a warm frame is 1"
plot ARG1 using "first":xticlabels(1) title "first frame" linecolor rgb sky, \
    ARG1 using "worst" title "worst frame" linecolor rgb red, 1 notitle linecolor rgb gray dashtype 2
