// SPDX-License-Identifier: MIT
#pragma once
#include "geometry/point_triangle.h"

namespace meshbound {
inline namespace MESHBOUND_ISA {

/// A triangle with all that `closest_on_triangle` computes from the triangle alone (four divisions among it): for
/// triangles whose distance to several points is wanted.
class PreparedTriangle {
 public:
  PreparedTriangle() = default;
  explicit PreparedTriangle(const CornerTriangle<double>& t)
      : t_(t), bc_(t.ac - t.ab), along_(detail::reciprocal(dot(t.ab, t.ab))), ab_ac_(dot(t.ab, t.ac)) {
    across_ = t.ac - (ab_ac_ * along_) * t.ab;
    per_across_ = detail::reciprocal(dot(across_, across_));
    per_ac_ = detail::reciprocal(dot(t.ac, t.ac));
    per_bc_ = detail::reciprocal(dot(bc_, bc_));
  }

  /// Gives the same bits as `closest_on_triangle`.
  [[nodiscard]] TriangleOffset<double> closest(Vec3 p) const {
    const Vec3 ap = p - t_.a;
    const Vec3 inside = from_inside(ap);
    TriangleOffset<double> best{inside, squared_length(inside)};
    const Vec3 by_ac = from_ac(ap), by_bc = from_bc(ap);
    detail::keep_nearer(best, by_ac, squared_length(by_ac));
    detail::keep_nearer(best, by_bc, squared_length(by_bc));
    return best;
  }
  /// Whether the squared distance that `closest` gives is at most `squared`; the cheap tests that mostly decide it come
  /// first.
  [[nodiscard]] bool is_within(Vec3 p, double squared) const {
    const Vec3 ap = p - t_.a;
    return squared_length(from_inside(ap)) <= squared || squared_length(from_ac(ap)) <= squared ||
           squared_length(from_bc(ap)) <= squared;
  }
  [[nodiscard]] const CornerTriangle<double>& triangle() const { return t_; }

 private:
  /// The vector to p from a point of the triangle: from the closest one, unless that lies on ac or bc.
  [[nodiscard]] Vec3 from_inside(Vec3 ap) const {
    const double ab_ap = dot(t_.ab, ap);
    const Vec3 rest = ap - (ab_ap * along_) * t_.ab;
    const double w = detail::clamped(dot(rest, across_) * per_across_, 1.0);
    const double v = detail::clamped((ab_ap - w * ab_ac_) * along_, 1.0 - w);
    return (ap - v * t_.ab) - w * t_.ac;
  }
  [[nodiscard]] Vec3 from_ac(Vec3 ap) const { return ap - detail::clamped(dot(t_.ac, ap) * per_ac_, 1.0) * t_.ac; }
  [[nodiscard]] Vec3 from_bc(Vec3 ap) const {
    const Vec3 bp = ap - t_.ab;
    return bp - detail::clamped(dot(bc_, bp) * per_bc_, 1.0) * bc_;
  }

  CornerTriangle<double> t_;
  Vec3 bc_, across_;
  double along_ = 0, ab_ac_ = 0, per_across_ = 0, per_ac_ = 0, per_bc_ = 0;
};

}  // namespace MESHBOUND_ISA
}  // namespace meshbound
