# SPDX-License-Identifier: GPL-3.0-or-later
set terminal svg size 1200,460 font "sans,11" background "white"
set output picture
set datafile separator comma
set datafile missing NaN  # rows of the other curves do not break a line
set logscale xy
set format x "10^{%T}"
set format y "10^{%T}"
set xlabel "error bound (sampling: error made), diagonals"
set ylabel "CPU seconds, one thread"
set key below
set xrange [1e-9:1e-1]
set multiplot layout 1,3
do for [pair in "'bunny / its 50%' 'fandisk / its 50%' 'bunny / its subdivision'"] {
  set title pair
  plot for [method in "'ours' 'cross-culling' 'CGAL bounded' 'CGAL sampled'"] 'error_bound.csv' \
    using ((strcol(1) eq pair && strcol(2) eq method) ? column(3) : NaN):4 with linespoints title method
}
unset multiplot
