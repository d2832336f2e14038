picture = ARG2
load system("dirname ".ARG0)."/style.gnuplot"
set style fill solid 0.9 noborder
set boxwidth 0.6
set yrange [0:*]
set xtics rotate by 30 right noenhanced
set ylabel "frames/s"
plot ARG1 using 0:2:xticlabels(1) notitle with boxes linecolor rgb sky
