picture = ARG2
load system("dirname ".ARG0)."/style.gnuplot"
set xlabel "layers"
set ylabel "ms a frame"
set logscale xy
set xrange [0.8:20]
set xtics (1, 2, 4, 8, 16)
layers(name) = real(name[strstrt(name, "-") + 1:])
set style data points
plot ARG1 using (layers(strcol("stream"))):"opaque_emulate" smooth unique with linespoints pointtype 6 linecolor rgb gray \
        title "emulate, opaque", \
    ARG1 using (layers(strcol("stream"))):"opaque_specialize" smooth unique with linespoints pointtype 6 linecolor rgb green \
        title "specialize, opaque", \
    ARG1 using (layers(strcol("stream"))):"blended_emulate" smooth unique with linespoints pointtype 7 linecolor rgb gray \
        dashtype 2 title "emulate, blended", \
    ARG1 using (layers(strcol("stream"))):"blended_specialize" smooth unique with linespoints pointtype 7 linecolor rgb green \
        dashtype 2 title "specialize, blended"
