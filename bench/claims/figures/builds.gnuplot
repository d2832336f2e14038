picture = ARG2
load system("dirname ".ARG0)."/style.gnuplot"
set terminal svg size 860, 760 font "DejaVu Sans,13" background "white" dynamic
set multiplot layout 2, 1
set logscale xy
set xrange [0.8:1000]
set xlabel "slots of the shader"
set ylabel "time to build, µs"
set format y "10^{%L}"
plot 3333 title "a tenth of a frame" linecolor rgb red dashtype 2, \
    ARG1 using "slots":"external_us" title "external" with points pointtype 7 pointsize 0.5 linecolor rgb purple, \
    ARG1 using "slots":"specialize_us" title "specialize" with points pointtype 13 pointsize 0.7 linecolor rgb green, \
    ARG1 using "slots":"thesis_us" title "specialize-thesis" with points pointtype 9 pointsize 0.6 linecolor rgb sky, \
    ARG1 using "slots":"stitch_us" title "stitch" with points pointtype 5 pointsize 0.5 linecolor rgb orange
set ylabel "code, bytes"
plot 10240 title "10 KB" linecolor rgb red dashtype 2, \
    ARG1 using "slots":"specialize_bytes" title "specialize" with points pointtype 13 pointsize 0.7 linecolor rgb green, \
    ARG1 using "slots":"stitch_bytes" title "stitch" with points pointtype 5 pointsize 0.5 linecolor rgb orange
unset multiplot
