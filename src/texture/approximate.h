// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "numeric/rounding.h"

namespace meshbound {

/// A real number that lies within `error` of `value`; an error that is not a number says that nothing is known. With
/// error 0 the number is `value`.
///
/// Each operation adds what it rounds (numeric/rounding.h): at most u |result|, and where a product or quotient
/// underflows at most 2^-1075, for which `tiny` stands. The errors are sums of up to ten rounded terms themselves:
/// less than 16 u of their size, which `grown` has room for, underflow of a term included where no `tiny` is added.
/// What overflows has an error that is infinite or not a number.
struct Approximate {
  double value = 0, error = 0;

  static constexpr double tiny = 0x1p-1000, small = 0x1p-900;
  static constexpr double grown = 1 + 0x1p-48;

  [[nodiscard]] bool is_zero() const { return value == 0 && error == 0; }
  /// A number about which nothing is known.
  [[nodiscard]] static Approximate unknown() { return {0, std::numeric_limits<double>::infinity()}; }
};

[[gnu::always_inline]] inline Approximate operator+(const Approximate& a, const Approximate& b) {
  const double value = a.value + b.value;
  return {value, (a.error + b.error + std::fabs(value) * unit_roundoff) * Approximate::grown};
}

inline Approximate operator-(const Approximate& a) { return {-a.value, a.error}; }

inline Approximate operator-(const Approximate& a, const Approximate& b) { return a + -b; }

[[gnu::always_inline]] inline Approximate operator*(const Approximate& a, const Approximate& b) {
  if (a.is_zero() || b.is_zero()) return {};
  const double value = a.value * b.value;
  const double error = std::fabs(a.value) * b.error + std::fabs(b.value) * a.error + a.error * b.error;
  const double underflow = std::fabs(value) < Approximate::small ? Approximate::tiny : 0;
  return {value, (error + std::fabs(value) * unit_roundoff + underflow) * Approximate::grown};
}

inline Approximate operator/(const Approximate& a, const Approximate& b) {
  if (a.is_zero() && std::fabs(b.value) > b.error) return {};
  const double value = a.value / b.value, least = (std::fabs(b.value) - b.error) * (1 - 0x1p-48);
  if (!(least > 0)) return Approximate::unknown();
  const double error = (a.error + std::fabs(value) * b.error) / least;
  return {value, (error + std::fabs(value) * unit_roundoff) * Approximate::grown + Approximate::tiny};
}

/// a0 b0 + a1 b1 + a2 b2. Its three products and two sums round by at most 3 u of the sum of the products' sizes, and
/// products may underflow by 3 2^-1075; where that sum is not tiny, 5 u of it are more than both and what the sum
/// itself rounds.
[[nodiscard]] [[gnu::always_inline]] inline Approximate sum_of_products(const std::array<Approximate, 3>& a,
                                                                        const std::array<Approximate, 3>& b) {
  double value = 0, size = 0, error = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double product = a[i].value * b[i].value;
    value += product;
    size += std::fabs(product);
    error += std::fabs(a[i].value) * b[i].error + std::fabs(b[i].value) * a[i].error + a[i].error * b[i].error;
  }
  if (!(size >= Approximate::small)) return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  return {value, (error + size * (5 * unit_roundoff)) * Approximate::grown};
}

/// Whether the sign is certain: then `sign` is -1, 0 or 1.
[[nodiscard]] inline bool sign_is_known(const Approximate& x, int& sign) {
  if (std::fabs(x.value) > x.error) {
    sign = x.value > 0 ? 1 : -1;
    return true;
  }
  sign = 0;
  return x.is_zero();
}

}  // namespace meshbound
