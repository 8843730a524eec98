# SPDX-License-Identifier: GPL-3.0-or-later
set terminal svg size 1000,420 font "sans,11" background "white"
set output picture
set datafile separator comma
set datafile missing NaN  # rows of the other curves do not break a line
set logscale x
set format x "10^{%T}"
set xlabel "triangles of both meshes"
set key top left
families = "'torus and noise' 'terrain and noise' 'sphere and coarser'"
set multiplot layout 1,2
set logscale y
set format y "10^{%T}"
set ylabel "CPU seconds, one thread, trees included"
plot for [family in families] 'scaling.csv' using 2:(strcol(1) eq family ? column(3) : NaN) with linespoints title family
unset logscale y
set format y "%g"
set yrange [0:*]
set ylabel "bytes a triangle, peak of the process"
plot for [family in families] 'scaling.csv' using 2:(strcol(1) eq family ? column(9) : NaN) with linespoints title family, \
  200 with lines dashtype 2 title "target from 1M"
unset multiplot
