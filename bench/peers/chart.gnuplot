# Draws the ratios of `make peers` as points, a row per workload and a colour per renderer.
#
#   gnuplot -c bench/peers/chart.gnuplot TABLE.csv CHART.svg CHART.png TITLE
#
# The table's columns are stream, engine, speedup, least, most; rows are in the table's order, from the top. The axis is
# logarithmic: equal lengths are equal factors. Bars go from the minimum to the maximum of the passes.

table = ARG1
distinct(name) = system(sprintf("awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == \"%s\") c = i; next } " . \
    "c && !seen[$c]++ { print $c }' '%s'", name, table))
position(list, name) = (sum [i = 1:words(list)] (word(list, i) eq name ? i : 0))

workloads = distinct("stream")
renderers = distinct("engine")
count = words(workloads)
colors = "#9a9a9a #000000 #e69f00 #56b4e9 #009e73 #cc79a7 #b8860b #0072b2 #d5002e #7f3fbf #6b8e23"

set datafile separator comma
set datafile columnheaders
set logscale x
set format x "%g"
set xlabel ARG4
set yrange [count + 0.5:0.5]
set ytics ("" 1) scale 0 nomirror noenhanced
do for [i = 1:count] { set ytics add (word(workloads, i) i) }
set grid xtics ytics linecolor rgb "#dddddd"
set key outside right top vertical samplen 1 noenhanced
set border 1
set xtics nomirror
set arrow from first 1, graph 0 to first 1, graph 1 nohead linewidth 1.5
set pointsize 0.9

y(renderer) = strcol("engine") eq renderer ? position(workloads, strcol("stream")) : NaN

do for [chart = 1:2] {
    if (chart == 1) { set terminal svg size 1200, 60 + 26 * count font "sans,13" background "white" } \
    else { set terminal pngcairo size 1200, 60 + 26 * count font "sans,11" background "white" }
    set output (chart == 1 ? ARG2 : ARG3)
    plot for [renderer in renderers] table using (column("speedup")):(y(renderer)):(column("least")):(column("most")) \
        with xerrorbars pointtype 7 linecolor rgb word(colors, 1 + (position(renderers, renderer) - 1) % words(colors)) \
        title renderer
    unset output
}
