# Draws the speedup column of a benchmark table as grouped bars, a group per stream and a bar per engine.
#
#   gnuplot -c bench/chart.gnuplot TABLE.csv CHART.svg CHART.png
#
# Columns are found by name (stream, engine, speedup); streams and engines are taken in the table's order. The axis
# is logarithmic: equal lengths are equal factors; the dashed line is the emulator.

table = ARG1

# The distinct values of a column, in order of appearance, as a list for word().
distinct(name) = system(sprintf("awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == \"%s\") c = i; next } " . \
    "c && !seen[$c]++ { print $c }' '%s'", name, table))
position(list, name) = (sum [i = 1:words(list)] (word(list, i) eq name ? i : 0))

streams = distinct("stream")
engines = distinct("engine")
count = words(engines)
width = 0.8 / count

set datafile separator comma
set datafile columnheaders
set style fill solid border -1
set boxwidth width
set logscale y
set ylabel "times the emulator's speed"
set format y "%g"
set yrange [0.5:*]
set xrange [0.4:words(streams) + 0.6]
set xtics ("" 1) rotate by -20 nomirror
do for [i = 1:words(streams)] { set xtics add (word(streams, i) i) }
set grid ytics
set key top left noenhanced
set xtics noenhanced
set arrow from graph 0, first 1 to graph 1, first 1 nohead dashtype 2

x(engine) = position(streams, strcol("stream")) + (position(engines, engine) - (count + 1) / 2.0) * width
height(engine) = strcol("engine") eq engine ? column("speedup") : NaN

do for [chart = 1:2] {
    if (chart == 1) { set terminal svg size 1000, 500 background "white" } \
    else { set terminal pngcairo size 1000, 500 background "white" }
    set output (chart == 1 ? ARG2 : ARG3)
    plot for [engine in engines] table using (x(engine)):(height(engine)) with boxes title engine, \
         for [engine in engines] '' using (x(engine)):(height(engine)):(sprintf("%.3g", height(engine))) \
             with labels offset 0, 0.6 font ",8" notitle
    unset output
}
