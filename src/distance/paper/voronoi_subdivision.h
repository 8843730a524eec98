// SPDX-License-Identifier: MIT
/// Voronoi subdivision: where to cut an edge of a triangle of A whose ends are nearest to different triangles of B.
/// Paper, section 5.2. Compiled once per instruction set.
#pragma once
#include <cmath>
#include <optional>

#include "geometry/point_triangle.h"

namespace meshbound {
inline namespace MESHBOUND_ISA {

/// The plane through a triangle: the signed distance of p is normal . (p - through). The normal is 0 for zero area.
struct SupportingPlane {
  explicit SupportingPlane(const CornerTriangle<double>& t) : normal(cross(t.ab, t.ac)), through(t.a) {
    const double norm = length(normal);
    normal = norm > 0 ? (1 / norm) * normal : Vec3{};
  }
  [[nodiscard]] double distance(const Vec3& p) const { return dot(normal, p - through); }

  Vec3 normal;
  Vec3 through;
};

/// The parameter t of the point v1 + t (v2 - v1) that is as far from the supporting plane of t1 as from that of t2. The
/// bisector of two planes is two planes, so there may be two such points: the one nearer to the middle. Nothing when
/// none lies between the ends.
inline std::optional<double> equidistant_parameter(const Vec3& v1, const Vec3& v2, const CornerTriangle<double>& t1,
                                                   const CornerTriangle<double>& t2) {
  const SupportingPlane p1(t1), p2(t2);
  std::optional<double> best;
  for (const double side : {1.0, -1.0}) {
    const double at_v1 = p1.distance(v1) - side * p2.distance(v1), at_v2 = p1.distance(v2) - side * p2.distance(v2);
    const double t = at_v1 / (at_v1 - at_v2);
    if (!(t > 0 && t < 1)) continue;
    if (!best || std::fabs(t - 0.5) < std::fabs(*best - 0.5)) best = t;
  }
  return best;
}

}  // namespace MESHBOUND_ISA
}  // namespace meshbound
