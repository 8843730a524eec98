# SPDX-License-Identifier: GPL-3.0-or-later
# CGAL's time over ours, pair by pair; a filled triangle where CGAL was ended at the limit.
set terminal svg size 1000,520 font "sans,11" background "white"
set output picture
set datafile separator comma
set logscale xy
set format x "10^{%T}"
set xlabel "triangles of both meshes"
set ylabel "CGAL bounded error / ours, CPU time"
set key outside right
limited(s) = strstrt(s, ">") > 0
number(s) = limited(s) ? real(substr(s, 3, strlen(s))) : real(s)
plot for [kind in "decimation near-zero identical coarse real apart decision"] 'pairs.csv' \
    using (column(3)+column(4)):((strcol(2) eq kind && strcol(14) ne "-" && !limited(strcol(14))) ? number(strcol(14)) : NaN) with points title kind, \
  'pairs.csv' using (column(3)+column(4)):(limited(strcol(14)) ? number(strcol(14)) : NaN) with points pointtype 9 title "at least (limit)", \
  1.5 with lines dashtype 2 title "never below 1.5", 30 with lines dashtype 3 title "decimation: 30"
