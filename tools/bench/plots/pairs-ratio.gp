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
limited(status) = status eq "limit"
plot for [kind in "decimation near-zero identical coarse real apart decision"] 'pairs.csv' \
    using (column(3)+column(4)):((strcol(2) eq kind && strcol(13) eq "done") ? column(15) : NaN) with points title kind, \
  'pairs.csv' using (column(3)+column(4)):(limited(strcol(13)) ? column(15) : NaN) with points pointtype 9 title "at least (limit)", \
  1.5 with lines dashtype 2 title "never below 1.5", 30 with lines dashtype 3 title "decimation: 30"
