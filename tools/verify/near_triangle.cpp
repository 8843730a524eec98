// SPDX-License-Identifier: MIT
#include "verify/near_triangle.h"

namespace meshbound::verify {
namespace {

struct Weights {
  double b = 0, c = 0;  ///< of the second and third corner
};

/// The point of the triangle nearest to p, up to rounding: Ericson, Real-Time Collision Detection (2005),
/// section 5.1.5.
Weights weights_of_closest(const Eigen::Vector3d& p, const Corners& t) {
  const Eigen::Vector3d ab = t[1] - t[0], ac = t[2] - t[0], ap = p - t[0], bp = p - t[1], cp = p - t[2];
  const double d1 = ab.dot(ap), d2 = ac.dot(ap), d3 = ab.dot(bp), d4 = ac.dot(bp), d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d1 <= 0 && d2 <= 0) return {0, 0};
  if (d3 >= 0 && d4 <= d3) return {1, 0};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {d1 / (d1 - d3), 0};
  if (d6 >= 0 && d5 <= d6) return {0, 1};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {0, d2 / (d2 - d6)};
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {1 - w, w};
  }
  const double sum = va + vb + vc;
  return {vb / sum, vc / sum};
}

/// A multiple of 2^-50 from 0 to 1, so that sums and differences of two are exact.
double snapped(double weight) {
  if (!(weight > 0)) return 0;
  return std::floor(std::min(weight, 1.0) * 0x1p50) * 0x1p-50;
}

Exact squared_length(const Vec<Exact>& v) { return dot(v, v); }

bool is_near_segment(const Vec<Exact>& p, const Vec<Exact>& a, const Vec<Exact>& b, const Exact& squared_tolerance) {
  const Vec<Exact> ab = b - a, ap = p - a;
  const Exact squared_edge = squared_length(ab), along = dot(ab, ap);
  if (sgn(along) <= 0) return squared_length(ap) <= squared_tolerance;
  if (along >= squared_edge) return squared_length(p - b) <= squared_tolerance;
  return squared_length(ap) * squared_edge - along * along <= squared_tolerance * squared_edge;
}

}  // namespace

/// Any weights b, c >= 0 with b + c <= 1 give a point of the triangle, and the distance to it is at least that to the
/// triangle.
bool surely_near(const Vec<Interval>& p, const Corners& triangle, double tolerance) {
  const Weights guess = weights_of_closest({p.x.middle(), p.y.middle(), p.z.middle()}, triangle);
  const double b = snapped(guess.b), c = std::min(snapped(guess.c), 1 - b);
  const Vec<Interval> at = to_vec<Interval>(triangle[0]);
  const Vec<Interval> offset = (p - at) - Interval(b) * (to_vec<Interval>(triangle[1]) - at) -
                               Interval(c) * (to_vec<Interval>(triangle[2]) - at);
  const Interval squared_tolerance = Interval(tolerance) * Interval(tolerance);
  return surely_not_negative(squared_tolerance - dot(offset, offset));
}

bool is_near(const Vec<Exact>& p, const Corners& triangle, double tolerance) {
  const Vec<Exact> a = to_vec<Exact>(triangle[0]), b = to_vec<Exact>(triangle[1]), c = to_vec<Exact>(triangle[2]);
  const Exact squared_tolerance = Exact(tolerance) * Exact(tolerance);
  const Vec<Exact> normal = cross<Exact>(b - a, c - a);
  const Exact squared_normal = squared_length(normal);
  const auto is_inside = [&](const Vec<Exact>& from, const Vec<Exact>& to) {
    return sgn(dot(normal, cross<Exact>(to - from, p - from))) >= 0;
  };
  if (sgn(squared_normal) > 0 && is_inside(a, b) && is_inside(b, c) && is_inside(c, a)) {
    const Exact height = dot<Exact>(normal, p - a);
    return height * height <= squared_tolerance * squared_normal;
  }
  return is_near_segment(p, a, b, squared_tolerance) || is_near_segment(p, b, c, squared_tolerance) ||
         is_near_segment(p, c, a, squared_tolerance);
}

}  // namespace meshbound::verify
