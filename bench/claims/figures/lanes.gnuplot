picture = ARG2
load system("dirname ".ARG0)."/style.gnuplot"
set xlabel "lanes"
set ylabel "time, one lane is 1"
set logscale y 2
set xrange [-0.2:3.2]
set xtics ("1" 0, "4" 1, "8" 2, "16" 3)
rows = int(system(sprintf("awk 'END { print NR - 1 }' '%s'", ARG1)))
cell(row, field) = real(system(sprintf("awk -F, 'NR == %d { print $%d }' '%s'", row + 2, field, ARG1)))
set print $shaders
do for [i = 0:rows - 1] { do for [j = 0:3] { print sprintf("%d %g", j, cell(i, j + 2)) }; print ""; print "" }
set print $ideal
print "0 1"; print "1 0.25"; print "2 0.125"; print "3 0.0625"
unset print
set datafile separator whitespace
unset datafile columnheaders
plot $shaders using 1:2 notitle with linespoints pointtype 7 pointsize 0.4 linecolor rgb sky, \
    $ideal using 1:2 title "1 over the lanes" with lines dashtype 2 linewidth 2 linecolor rgb gray
