// SPDX-License-Identifier: MIT
/// Which of two or three triangles of B is to bound a point, and where that changes inside a piece. Compiled once per
/// instruction set.
#pragma once
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "bvh/nearest.h"
#include "geometry/point_triangle.h"
#include "proof/piece.h"

namespace meshbound {
inline namespace MESHBOUND_ISA {

/// A triangle t serves a point that is within the target of it, or no further from it than from another triangle.
class Choice {
 public:
  Choice(const CornerTriangle<double>& t, const CornerTriangle<double>& other, double target)
      : both_{gather4(t.a, other.a, t.a, other.a), gather4(t.ab, other.ab, t.ab, other.ab),
              gather4(t.ac, other.ac, t.ac, other.ac)},
        target_(target) {}

  /// How much too far two points are from t: positive where t does not serve them.
  [[nodiscard]] std::pair<double, double> excess(const Vec3& p, const Vec3& q) const {
    const Double4 length = square_root(closest_on_triangle(both_, gather4(p, p, q, q)).squared_distance);
    return {length[0] - std::max(length[1], target_), length[2] - std::max(length[3], target_)};
  }

  [[nodiscard]] double target() const { return target_; }

 private:
  CornerTriangle<Double4> both_;  ///< t, other, t, other
  double target_;
};

/// The search for a share s of the way from a point that t serves to one that it does not, up to which t serves:
/// served + s (unserved - served) is served, and points little beyond it are not. By the rule of false position in its
/// Illinois form. 0 <= s < 1.
class LastServed {
 public:
  static constexpr int max_steps = 24;

  LastServed(const Vec3& served, double excess_there, const Vec3& unserved, double excess_beyond)
      : served_(served), way_(unserved - served), excess_there_(excess_there), excess_beyond_(excess_beyond) {}

  [[nodiscard]] double share() const { return from_; }

  /// Chooses the next point to look at; false when the search has ended.
  bool aim(double target) {
    constexpr double near_enough = 0x1p-48;  // of the target: far below any error bound that can be reached
    share_ = (from_ * excess_beyond_ - to_ * excess_there_) / (excess_beyond_ - excess_there_);
    open_ = open_ && excess_there_ < -near_enough * target && share_ > from_ && share_ < to_;
    return open_;
  }
  [[nodiscard]] Vec3 point() const { return served_ + share_ * way_; }

  /// Takes the excess at `point`, unless the search has ended.
  void narrow(double here) {
    if (!open_) return;
    if (here <= 0) {
      from_ = share_;
      excess_there_ = here;
      repeats_ = repeats_ > 0 ? repeats_ + 1 : 1;
      if (repeats_ > 1) excess_beyond_ /= 2;
    } else {
      to_ = share_;
      excess_beyond_ = here;
      repeats_ = repeats_ < 0 ? repeats_ - 1 : -1;
      if (repeats_ < -1) excess_there_ /= 2;
    }
  }

 private:
  Vec3 served_, way_;
  double excess_there_, excess_beyond_;
  double from_ = 0, to_ = 1, share_ = 0;
  int repeats_ = 0;  ///< steps in a row that moved the same end, positive for `from_`
  bool open_ = true;
};

/// Runs two searches side by side.
inline void run_both(const Choice& choice, LastServed& first, LastServed& second) {
  for (int step = 0; step < LastServed::max_steps; ++step) {
    const bool first_goes_on = first.aim(choice.target()), second_goes_on = second.aim(choice.target());
    if (!first_goes_on && !second_goes_on) return;
    const auto [here, there] = choice.excess(first.point(), second.point());
    first.narrow(here);
    second.narrow(there);
  }
}

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
