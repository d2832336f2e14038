picture = ARG2
load system("dirname ".ARG0)."/style.gnuplot"
set logscale xy
set xlabel "slots of the shader"
set ylabel "times the speed of emulate"
set xrange [0.8:1000]
plot 1 notitle linecolor rgb gray dashtype 2, \
    ARG1 using "slots":"batch" title "batch" with points pointtype 7 pointsize 0.5 linecolor rgb gray, \
    ARG1 using "slots":"stitch" title "stitch" with points pointtype 5 pointsize 0.5 linecolor rgb orange, \
    ARG1 using "slots":"thesis" title "specialize-thesis" with points pointtype 9 pointsize 0.6 linecolor rgb sky, \
    ARG1 using "slots":"specialize" title "specialize" with points pointtype 13 pointsize 0.7 linecolor rgb green
