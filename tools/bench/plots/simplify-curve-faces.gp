# SPDX-License-Identifier: GPL-3.0-or-later
# Faces that are left against the tolerance.
set terminal svg size 1000,420 font "sans,11" background "white"
set output picture
set datafile separator comma
set datafile missing NaN  # rows of the other curves do not break a line
set logscale xy
set xlabel "tolerance, % of the diagonal"
set ylabel "faces"
set key top right
set multiplot layout 1,2
do for [mesh in "fandisk bunny"] {
  set title mesh
  plot for [method in "'normal' 'bisecting the count'"] 'simplify-curve.csv' \
    using ((strcol(1) eq mesh && strcol(2) eq method) ? column(3) : NaN):4 with linespoints title method
}
unset multiplot
