picture = ARG2
load system("dirname ".ARG0)."/style.gnuplot"
set key outside right center vertical
set style data histograms
set style histogram rowstacked
set style fill solid 0.9 noborder
set boxwidth 0.7
set xtics rotate by 25 right noenhanced
set yrange [0:*]
set ylabel "ms, all routines"
rest(i) = column("all") - column("record") - column("reduce") - column("common") - column("dead") - column("allocate") \
    - column("select") - column("encode")
plot ARG1 using "record":xticlabels(strcol(1)." ".strcol(2)) title "record" linecolor rgb sky, \
    ARG1 using "reduce" title "reduce" linecolor rgb green, ARG1 using "common" title "common" linecolor rgb orange, \
    ARG1 using "dead" title "dead" linecolor rgb red, ARG1 using (rest(0)) title "other passes" linecolor rgb gray, \
    ARG1 using "allocate" title "allocate" linecolor rgb purple, ARG1 using "select" title "select" linecolor rgb "#4d6b8a", \
    ARG1 using "encode" title "encode" linecolor rgb "#222222"
