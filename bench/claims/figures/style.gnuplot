# Settings of all figures. Each template is called with ARG1, the table, and ARG2, the picture, and sets `picture`.
set terminal svg size 860, 460 font "DejaVu Sans,13" background "white" dynamic
set output picture
set datafile separator comma
set datafile columnheaders
set border 3 linecolor rgb "#5b6875"
set tics nomirror out textcolor rgb "#1c2733"
set grid linecolor rgb "#e3e8ec"
set key outside top center horizontal noenhanced
gray = "#7b8792"; orange = "#d98200"; sky = "#3a9bd9"; green = "#1b8f5a"; red = "#c23b2e"; purple = "#7a4fa3"
