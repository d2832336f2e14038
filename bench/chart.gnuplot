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

# Grey for the emulator, and colours for the other engines that are distinct without colour vision too.
colors = "#9a9a9a #e69f00 #d55e00 #56b4e9 #0072b2 #009e73 #cc79a7 #000000 #6a3d9a #8c510a #f0e442"

set datafile separator comma
set datafile columnheaders
stats table using (column("speedup")) nooutput
set style fill solid noborder
set boxwidth width
set logscale y
set ylabel "times the emulator's speed"
set format y "%g"
set yrange [0.5:1.8 * STATS_max]
set xrange [0.4:words(streams) + 0.6]
set xtics ("" 1) scale 0 nomirror
do for [i = 1:words(streams)] { set xtics add (word(streams, i) i) }
set grid ytics
set key above center horizontal samplen 1 noenhanced
set border 3
set ytics nomirror
set xtics noenhanced
set arrow from graph 0, first 1 to graph 1, first 1 nohead dashtype 2

x(engine) = position(streams, strcol("stream")) + (position(engines, engine) - (count + 1) / 2.0) * width
height(engine) = strcol("engine") eq engine ? column("speedup") : NaN

do for [chart = 1:2] {
    if (chart == 1) { set terminal svg size 1500, 520 font "sans,13" background "white" } \
    else { set terminal pngcairo size 1500, 520 font "sans,11" background "white" }
    set output (chart == 1 ? ARG2 : ARG3)
    plot for [engine in engines] table using (x(engine)):(height(engine)) with boxes \
             linecolor rgb word(colors, 1 + (position(engines, engine) - 1) % words(colors)) title engine, \
         for [engine in engines] '' using (x(engine)):(height(engine)):(sprintf(height(engine) < 10 ? "%.1f" : "%.0f", height(engine))) \
             with labels left rotate by 90 offset 0, 0.3 font ",9" notitle
    unset output
}
