# SPDX-License-Identifier: GPL-3.0-or-later
# Figure 9 of the paper: time and distance over the steps; the phases as counts, on the right.
set terminal svg size 1200,900 font "sans,11" background "white"
set output picture
set datafile separator comma
set xlabel "separation, longest dimensions"
set xrange [3:0]
set key top left
set y2tics
set ytics nomirror
set multiplot layout 3,2
do for [pair in "Bird1-Bird2 Watch1-Watch2 Puma1-Puma2 Bunny1-Bunny2 Fish1-Fish2 Dog-Lion"] {
  file = 'paper-'.pair.'.csv'
  if (system("test -e ".file." && echo yes") ne "yes") { continue }
  set title pair
  set ylabel "ms, closest-point queries / 1000"
  set y2label "distance, longest dimensions"
  plot file using 1:2 every ::2 with lines title "time, ms", \
    file using 1:(column(6)/1000) every ::2 with lines title "queries / 1000", \
    file using 1:3 every ::2 axes x1y2 with lines dashtype 2 title "distance (right)"
}
unset multiplot
