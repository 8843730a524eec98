// SPDX-License-Identifier: MIT
/// Powers of two by which numbers are multiplied without rounding, so that intervals of their products do not underflow
/// or overflow: all would then be left to the rationals, which take a hundred times as long.
#pragma once
#include <algorithm>
#include <cmath>

namespace meshbound::verify {

/// A power of two that takes a positive `size` to at least 1 and less than 2. Both the power and its inverse are normal
/// doubles: sizes below 2^-1000 or above 2^1000 are taken to 2^-74 at least, and to 2^24 at most.
inline double power_for(double size) { return std::ldexp(1.0, std::clamp(-std::ilogb(size), -1000, 1000)); }

/// A power of two by which all numbers can be multiplied without rounding, after which the largest is about 1; 1 where
/// there is none, and for numbers of usual size. `for_each` calls what it is given with each number; all are finite.
/// Usual sizes are those whose 20th power, the highest of texture coordinates in the products here, is between 2^-320
/// and 2^640: far from the ends of what doubles hold.
template <class ForEach>
double common_scale(const ForEach& for_each) {
  double size = 0;
  for_each([&](double x) { size = std::max(size, std::fabs(x)); });
  if (size == 0 || (size > 0x1p-16 && size < 0x1p32)) return 1;
  const double scale = power_for(size);
  bool is_exact = true;
  for_each([&](double x) { is_exact = is_exact && x * scale / scale == x; });
  return is_exact ? scale : 1;
}

}  // namespace meshbound::verify
