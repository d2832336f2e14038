picture = ARG2
load system("dirname ".ARG0)."/style.gnuplot"
set style fill solid 0.9 noborder
set boxwidth 0.6
set logscale y
set yrange [0.01:*]
set ylabel "ms"
plot ARG1 using 0:2:xticlabels(1) notitle with boxes linecolor rgb sky
