picture = ARG2
load system("dirname ".ARG0)."/style.gnuplot"
set style fill solid 0.9 noborder
set boxwidth 0.6
set logscale y
set yrange [0.05:*]
set xtics rotate by 30 right noenhanced
set ylabel "times the speed of emulate"
plot ARG1 using 0:(0.05):(column(0) - 0.3):(column(0) + 0.3):(0.05):2:xticlabels(1) notitle with boxxyerror linecolor rgb sky, \
    1 notitle linecolor rgb gray dashtype 2
