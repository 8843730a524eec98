// SPDX-License-Identifier: MIT
/// The two kinds of numbers that the verifier computes with: rationals, which decide everything, and intervals of
/// doubles, which decide nearly everything in a hundredth of the time. An interval contains the real number it stands
/// for; what it cannot tell is left to the rationals.
#pragma once
#include <gmpxx.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

namespace meshbound::verify {

using Exact = mpq_class;

class Interval {
 public:
  Interval(double exact = 0) : lo_(exact), hi_(exact) {}  // NOLINT(google-explicit-constructor): a double is a number

  /// GMP rounds to doubles towards zero, so less than a unit in the last place is cut off: see `rounded`. The rational
  /// must be within the range of doubles.
  static Interval around(const Exact& x) { return sgn(x) == 0 ? Interval(0) : rounded(x.get_d(), x.get_d()); }

  [[nodiscard]] double lower() const { return lo_; }
  [[nodiscard]] double upper() const { return hi_; }
  [[nodiscard]] double middle() const { return 0.5 * lo_ + 0.5 * hi_; }
  /// Nothing but 0: products with it are exact, and free of the smallest doubles, with which processors are slow.
  [[nodiscard]] bool is_zero() const { return lo_ == 0 && hi_ == 0; }

  friend Interval operator+(const Interval& a, const Interval& b) { return rounded_sum(a.lo_ + b.lo_, a.hi_ + b.hi_); }
  friend Interval operator-(const Interval& a, const Interval& b) { return rounded_sum(a.lo_ - b.hi_, a.hi_ - b.lo_); }
  friend Interval operator*(const Interval& a, const Interval& b) {
    if (a.is_zero() || b.is_zero()) return Interval(0);
    const double p = a.lo_ * b.lo_, q = a.lo_ * b.hi_, r = a.hi_ * b.lo_, s = a.hi_ * b.hi_;
    if (!(std::fabs(p) + std::fabs(q) + std::fabs(r) + std::fabs(s) < infinity)) return everything();
    return rounded(std::min(std::min(p, q), std::min(r, s)), std::max(std::max(p, q), std::max(r, s)));
  }
  /// Everything when b may be 0.
  friend Interval operator/(const Interval& a, const Interval& b) {
    if (!(b.lo_ > 0 || b.hi_ < 0)) return everything();
    const double p = a.lo_ / b.lo_, q = a.lo_ / b.hi_, r = a.hi_ / b.lo_, s = a.hi_ / b.hi_;
    if (!(std::fabs(p) + std::fabs(q) + std::fabs(r) + std::fabs(s) < infinity)) return everything();
    return rounded(std::min(std::min(p, q), std::min(r, s)), std::max(std::max(p, q), std::max(r, s)));
  }

 private:
  static constexpr double infinity = std::numeric_limits<double>::infinity();
  static Interval everything() { return Interval(-infinity, infinity); }
  Interval(double lo, double hi) : lo_(lo), hi_(hi) {}

  /// An operation of IEEE doubles is off by at most half a unit in the last place, 2^-53 of the result, or 2^-1075
  /// where it underflows. 2^-52 of the result and the smallest double are more than that, the rounding of this step
  /// included.
  static Interval rounded(double lo, double hi) {
    constexpr double smallest = std::numeric_limits<double>::denorm_min();
    return finite(lo - (std::fabs(lo) * 0x1p-52 + smallest), hi + (std::fabs(hi) * 0x1p-52 + smallest));
  }
  /// Sums and differences of doubles are exact where they underflow, as all doubles are multiples of the smallest one.
  static Interval rounded_sum(double lo, double hi) {
    return finite(lo - std::fabs(lo) * 0x1p-52, hi + std::fabs(hi) * 0x1p-52);
  }
  static Interval finite(double below, double above) {
    if (!(std::fabs(below) < infinity && std::fabs(above) < infinity)) return everything();
    return {below, above};
  }

  double lo_, hi_;
};

inline bool surely_positive(const Interval& x) { return x.lower() > 0; }
inline bool surely_positive(const Exact& x) { return sgn(x) > 0; }
inline bool surely_negative(const Interval& x) { return x.upper() < 0; }
inline bool surely_negative(const Exact& x) { return sgn(x) < 0; }
/// For rationals "surely" means exactly: a sign that is not one of these two is 0.
inline bool surely_not_negative(const Interval& x) { return x.lower() >= 0; }
inline bool surely_not_negative(const Exact& x) { return sgn(x) >= 0; }

template <class Number>
struct Vec {
  Number x, y, z;

  friend Vec operator+(const Vec& a, const Vec& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Vec operator-(const Vec& a, const Vec& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend Vec operator*(const Number& s, const Vec& a) { return {s * a.x, s * a.y, s * a.z}; }
};

template <class Number>
Number dot(const Vec<Number>& a, const Vec<Number>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class Number>
Vec<Number> cross(const Vec<Number>& a, const Vec<Number>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Doubles are taken as they are: nothing is rounded. The coordinates must be finite.
template <class Number>
Vec<Number> to_vec(const Eigen::Vector3d& p) {
  return {Number(p.x()), Number(p.y()), Number(p.z())};
}

}  // namespace meshbound::verify
