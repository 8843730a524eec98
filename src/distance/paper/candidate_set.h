// SPDX-License-Identifier: MIT
/// The set L of triangles of B that can matter for a triangle T of A and everything inside it. Paper, section 5.1 and
/// Lemma 3. Compiled once per instruction set.
#pragma once
#include <array>
#include <cmath>
#include <vector>

#include "distance/paper/group_traversal.h"
#include "proof/piece.h"

namespace meshbound {

inline namespace MESHBOUND_ISA {

/// A triangle of L, with its squared distances to the corners of T.
struct Candidate {
  std::uint32_t slot = 0;
  std::array<double, 3> squared{};
};

/// A ball around a triangle of A: its centroid and the distance to the furthest corner.
struct CentroidBall {
  explicit CentroidBall(const TriangleCorners& t) : centre(centroid(t)) {
    for (const Vec3& corner : t) radius = std::max(radius, length(corner - centre));
  }

  /// The squared distance from the centre up to which a triangle of B belongs to L. L = {t : d(T, t) <= upper} holds
  /// the closest triangle of every point of T, for that is within h(T, B) <= upper (Lemma 3); d(centre, t) - radius is
  /// at most d(T, t), so this keeps all of L and a few more. `slack` covers the rounding of both distances.
  [[nodiscard]] double reach_squared(double upper_squared, double slack) const {
    const double reach = std::sqrt(upper_squared) + radius + 2 * slack;
    return reach * reach * (1 + 0x1p-40);
  }

  Vec3 centre;
  double radius = 0;
};

/// Appends L for a triangle whose distance to B is at most the root of `upper_squared`.
inline void collect_candidates(const Bvh::Data& data, const TriangleCorners& corners, double upper_squared,
                               double slack, std::vector<Candidate>& candidates, QueryCounters& counters) {
  const CentroidBall ball(corners);
  const double reach = ball.reach_squared(upper_squared, slack);
  const double wider = std::sqrt(upper_squared) + 2 * slack;
  visit_near_triangle(data, corners, wider * wider, counters, [&](std::uint32_t block) {
    const CornerTriangle<Double4> t = triangles_of_block(data, block);
    const Double4 from_centre = closest_on_triangle(t, broadcast4(ball.centre)).squared_distance;
    Double4 squared[3];
    for (int k = 0; k < 3; ++k) squared[k] = closest_on_triangle(t, broadcast4(corners[k])).squared_distance;
    for (std::uint32_t lane = 0; lane < block_width; ++lane) {
      const std::uint32_t slot = block * block_width + lane;
      if (slot < data.triangle_count() && from_centre[lane] <= reach)
        candidates.push_back({slot, {squared[0][lane], squared[1][lane], squared[2][lane]}});
    }
    return wider * wider;
  });
}

}  // namespace MESHBOUND_ISA
}  // namespace meshbound
