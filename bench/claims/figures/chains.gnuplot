picture = ARG2
load system("dirname ".ARG0)."/style.gnuplot"
set xlabel "independent chains"
set ylabel "multiply-adds, thousand million a second"
set yrange [0:*]
set xrange [0:13]
plot ARG1 using "chains":"rate" notitle with linespoints pointtype 7 linewidth 2 linecolor rgb sky
