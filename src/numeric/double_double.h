// SPDX-License-Identifier: MIT
/// Numbers of about 106 bits as the unevaluated sum of two doubles. `long double` has 64 bits on one machine and 113 on
/// another; these give the same bits wherever doubles follow IEEE 754.
///
/// Sources: D. E. Knuth, The Art of Computer Programming 2, 4.2.2 (error of a sum); T. J. Dekker, A floating-point
/// technique for extending the available precision, Numerische Mathematik 18 (1971) (error of a product, and the four
/// operations). Dekker's splitting overflows beyond 2^996: the working frame keeps magnitudes far below that.
#pragma once
#include "numeric/isa.h"

namespace meshbound {
inline namespace MESHBOUND_ISA {

/// `high` is the sum rounded to double. A double converts to it without error.
struct DoubleDouble {
  double high = 0, low = 0;

  DoubleDouble() = default;
  DoubleDouble(double value) : high(value) {}
  DoubleDouble(double high_part, double low_part) : high(high_part), low(low_part) {}
  explicit operator double() const { return high; }
};

/// a + b and the rounding error of that sum.
inline DoubleDouble exact_sum(double a, double b) {
  const double sum = a + b, b_part = sum - a;
  return {sum, (a - (sum - b_part)) + (b - b_part)};
}

/// a * b and the rounding error of that product, but where it underflows.
inline DoubleDouble exact_product(double a, double b) {
  constexpr double splitter = 0x1p27 + 1;  // leaves 26 bits in each half
  const double product = a * b, a_scaled = splitter * a, b_scaled = splitter * b;
  const double a_high = a_scaled - (a_scaled - a), b_high = b_scaled - (b_scaled - b);
  const double a_low = a - a_high, b_low = b - b_high;
  return {product, ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low};
}

inline DoubleDouble operator-(const DoubleDouble& a) { return {-a.high, -a.low}; }

inline DoubleDouble operator+(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble sum = exact_sum(a.high, b.high);
  return exact_sum(sum.high, sum.low + (a.low + b.low));
}

inline DoubleDouble operator-(const DoubleDouble& a, const DoubleDouble& b) { return a + -b; }

inline DoubleDouble operator*(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble product = exact_product(a.high, b.high);
  return exact_sum(product.high, product.low + (a.high * b.low + a.low * b.high));
}

/// One step of Newton's method from the quotient of the leading parts.
inline DoubleDouble operator/(const DoubleDouble& a, const DoubleDouble& b) {
  const double quotient = a.high / b.high;
  const DoubleDouble rest = a - b * DoubleDouble(quotient);
  return exact_sum(quotient, rest.high / b.high);
}

inline bool operator<(const DoubleDouble& a, const DoubleDouble& b) {
  return a.high < b.high || (a.high == b.high && a.low < b.low);
}
inline bool operator>(const DoubleDouble& a, const DoubleDouble& b) { return b < a; }

inline DoubleDouble select(bool mask, const DoubleDouble& yes, const DoubleDouble& no) { return mask ? yes : no; }

}  // namespace MESHBOUND_ISA
}  // namespace meshbound
