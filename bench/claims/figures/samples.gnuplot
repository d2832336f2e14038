picture = ARG2
load system("dirname ".ARG0)."/style.gnuplot"
set xlabel "multiply-adds of four components beside a bilinear sample"
set ylabel "ns a pixel"
set y2label "llvmpipe's time over specialize's"
set y2tics
set yrange [0:*]
set y2range [0:*]
plot ARG1 using "multiply_adds":"llvmpipe_ns" title "llvmpipe" with linespoints pointtype 7 linewidth 2 linecolor rgb orange, \
    ARG1 using "multiply_adds":"specialize_ns" title "specialize" with linespoints pointtype 7 linewidth 2 linecolor rgb green, \
    ARG1 using "multiply_adds":(column("llvmpipe_ns") / column("specialize_ns")) axes x1y2 title "the quotient, right axis" \
    with linespoints pointtype 5 dashtype 2 linewidth 2 linecolor rgb gray
