// SPDX-License-Identifier: MIT
/// Which of two or three triangles of B is to bound a point, and where that changes inside a piece. Compiled once per
/// instruction set.
#pragma once
#include <algorithm>
#include <cmath>
#include <optional>

#include "geometry/point_triangle.h"
#include "proof/piece.h"

namespace meshbound {
inline namespace MESHBOUND_ISA {

/// A triangle t serves a point that is within the target of it, or no further from it than from another triangle.
struct Choice {
  CornerTriangle<double> t, other;
  double target;

  /// How much too far a point is from t: positive where t does not serve it.
  [[nodiscard]] double excess(const Vec3& p) const {
    const double to_other = std::sqrt(closest_on_triangle(other, p).squared_distance);
    return std::sqrt(closest_on_triangle(t, p).squared_distance) - std::max(to_other, target);
  }

  /// A share s of the way from `served` to `unserved` up to which t serves: served + s (unserved - served) is served,
  /// and points little beyond it are not. By the rule of false position in its Illinois form. 0 <= s < 1.
  [[nodiscard]] double last_served(const Vec3& served, double excess_there, const Vec3& unserved,
                                   double excess_beyond) const {
    constexpr int max_steps = 24;
    constexpr double near_enough = 0x1p-48;  // of the target: far below any error bound that can be reached
    double from = 0, to = 1;
    int repeats = 0;  // steps in a row that moved the same end, positive for `from`
    for (int step = 0; step < max_steps && excess_there < -near_enough * target; ++step) {
      const double share = (from * excess_beyond - to * excess_there) / (excess_beyond - excess_there);
      if (!(share > from && share < to)) break;
      const double here = excess(served + share * (unserved - served));
      if (here <= 0) {
        from = share;
        excess_there = here;
        repeats = repeats > 0 ? repeats + 1 : 1;
        if (repeats > 1) excess_beyond /= 2;
      } else {
        to = share;
        excess_beyond = here;
        repeats = repeats < 0 ? repeats - 1 : -1;
        if (repeats < -1) excess_there /= 2;
      }
    }
    return from;
  }
};

/// How much nearer the triangle `other` is to a point than t, and the gradient of this function of the point.
struct Lead {
  double value = 0;
  Vec3 gradient;
};

inline Lead lead(const CornerTriangle<double>& t, const CornerTriangle<double>& other, const Vec3& p) {
  const TriangleOffset<double> to_t = closest_on_triangle(t, p), to_other = closest_on_triangle(other, p);
  const double d = std::sqrt(to_t.squared_distance), e = std::sqrt(to_other.squared_distance);
  Lead result{d - e, {}};
  if (d > 0) result.gradient = result.gradient + (1 / d) * to_t.offset;
  if (e > 0) result.gradient = result.gradient - (1 / e) * to_other.offset;
  return result;
}

/// Whether a point of the plane of a piece lies in the piece, up to rounding.
inline bool contains(const Piece& piece, const Vec3& p) {
  Vec3 normal;
  for (std::uint32_t i = 2; i < piece.count; ++i)
    normal = normal + cross(piece.corner(i - 1) - piece.corner(0), piece.corner(i) - piece.corner(0));
  for (std::uint32_t i = 0; i < piece.count; ++i) {
    const Vec3 from = piece.corner(i), to = piece.corner(i + 1 == piece.count ? 0 : i + 1);
    if (dot(cross(to - from, p - from), normal) < 0) return false;
  }
  return true;
}

/// A point of a piece that is equally far from three triangles, by Newton's method from a point of the piece; absent
/// where that ends elsewhere.
inline std::optional<Vec3> equidistant_point(const Piece& piece, const Vec3& from, const CornerTriangle<double>& t,
                                             const CornerTriangle<double>& u, const CornerTriangle<double>& v) {
  constexpr int max_steps = 8;
  const Vec3 along = piece.corner(1) - piece.corner(0), across = piece.corner(piece.count - 1) - piece.corner(0);
  Vec3 p = from;
  for (int step = 0; step < max_steps; ++step) {
    const Lead first = lead(t, u, p), second = lead(t, v, p);
    const double a = dot(first.gradient, along), b = dot(first.gradient, across), c = dot(second.gradient, along),
                 d = dot(second.gradient, across), determinant = a * d - b * c;
    const double x = (b * second.value - d * first.value) / determinant,
                 y = (c * first.value - a * second.value) / determinant;
    if (!(std::fabs(x) + std::fabs(y) <= 4)) return std::nullopt;  // far off, or no direction
    p = p + (x * along + y * across);
    if (std::fabs(x) + std::fabs(y) < 0x1p-40) break;
  }
  if (!contains(piece, p)) return std::nullopt;
  return p;
}

}  // namespace MESHBOUND_ISA
}  // namespace meshbound
