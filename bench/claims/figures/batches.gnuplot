picture = ARG2
load system("dirname ".ARG0)."/style.gnuplot"
set key outside right center vertical
set xlabel "elements of a batch"
set ylabel "ns an element"
set logscale xy 2
set xrange [3:400]
set xtics (4, 8, 16, 32, 64, 128, 256)
shaders = system(sprintf("awk -F, 'NR > 1 && !seen[$1]++ { print $1 }' '%s'", ARG1))
plot for [shader in shaders] ARG1 using "elements":(strcol("shader") eq shader ? column("ns") : NaN) \
    with linespoints pointtype 7 pointsize 0.5 title shader
