picture = ARG2
load system("dirname ".ARG0)."/style.gnuplot"
set style data histograms
set style histogram clustered gap 1
set style fill solid 0.9 noborder
set xtics rotate by 40 right noenhanced
set ylabel "count"
plot ARG1 using "recorded":xticlabels(1) title "operations recorded" linecolor rgb sky, \
    ARG1 using "lanes_8" title "machine instructions, 8 lanes" linecolor rgb green
