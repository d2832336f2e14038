picture = ARG2
load system("dirname ".ARG0)."/style.gnuplot"
set xlabel "lanes"
set ylabel "time, one lane is 1"
set logscale y 2
set xrange [-0.2:3.2]
set xtics ("1" 0, "4" 1, "8" 2, "16" 3)
set style data lines
set parametric
set trange [0:1]
rows = int(system(sprintf("awk 'END { print NR - 1 }' '%s'", ARG1)))
cell(row, field) = real(system(sprintf("awk -F, 'NR == %d { print $%d }' '%s'", row + 2, field, ARG1)))
set print $lines
do for [i = 0:rows - 1] { do for [j = 0:3] { print sprintf("%d %g", j, cell(i, j + 2)) }; print ""; print "" }
unset print
unset parametric
set datafile separator whitespace
unset datafile columnheaders
plot $lines using 1:2 notitle with linespoints pointtype 7 pointsize 0.4 linecolor rgb sky, \
    [0:3] 1 / (x == 0 ? 1 : 2 ** (x + 1)) title "1 over the lanes" with lines dashtype 2 linecolor rgb gray
