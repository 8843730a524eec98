// SPDX-License-Identifier: MIT
#include "distance/shortcuts/point_like.h"

#include <algorithm>
#include <limits>

#include "bvh/bvh_data.h"
#include "distance/shortcuts/identical.h"
#include "geometry/safe_length.h"
#include "numeric/rounding.h"

namespace meshbound {
namespace {

/// A point in the world, and the lengths that its rounding goes with: these may cancel in the point.
struct WorldPoint {
  WorldPoint(const PlacedModel& model, const Vec3& working) {
    const Vec3 p = model.bvh->data().frame.to_model(working);
    const Eigen::Vector3d of_model(p.x, p.y, p.z);
    at = model.pose * of_model;
    reach = safe_length(of_model) + safe_length(model.pose.translation());
  }
  Eigen::Vector3d at;
  double reach = 0;
};

/// The vertex of B that is nearest to a point. O(n).
std::uint32_t nearest_vertex(const PlacedModel& b, const Eigen::Vector3d& to) {
  const auto& vertices = b.bvh->data().vertices;
  std::uint32_t nearest = 0;
  double distance = std::numeric_limits<double>::infinity();
  for (std::uint32_t v = 0; v < vertices.size(); ++v) {
    const double d = safe_length(WorldPoint(b, vertices[v]).at - to);
    if (!(d < distance)) continue;
    distance = d;
    nearest = v;
  }
  return nearest;
}

}  // namespace

OneSidedDistance distance_to_point_like(const PlacedModel& placed_a, const PlacedModel& placed_b) {
  const Bvh::Data& a = placed_a.bvh->data();
  const Bvh::Data& b = placed_b.bvh->data();
  const auto [centre, reach_of_centre] = WorldPoint(placed_b, b.vertices[0]);
  OneSidedDistance result;
  std::uint32_t farthest = 0;
  double distance = -1, reach = reach_of_centre;
  for (std::uint32_t v = 0; v < a.vertices.size(); ++v) {
    const WorldPoint p(placed_a, a.vertices[v]);
    reach = std::max(reach, p.reach);
    if (const double d = safe_length(p.at - centre); d > distance) {
      distance = d;
      farthest = v;
    }
  }
  // In u of the larger reach: a point out of its frame is off by 4, its pose (6 roundings a coordinate) by 7 more; two
  // of them, their difference and its length make 28. The diagonal of B, stretched by what a pose may drift (below
  // 2^-29; 1e-9 is refused elsewhere), bounds how far B reaches from one of its own vertices.
  const double size_of_b = b.diagonal * (1 + 0x1p-28);
  const double slack = 64 * unit_roundoff * reach + size_of_b + 0x1p-1070;  // 9 products of a pose may underflow
  result.bounds = {std::max(0.0, next_down(distance - slack)), next_up(distance + slack)};
  const Eigen::Vector3d from = WorldPoint(placed_a, a.vertices[farthest]).at;
  const std::uint32_t nearest = nearest_vertex(placed_b, from);
  const Eigen::Vector3d to = WorldPoint(placed_b, b.vertices[nearest]).at;
  result.witness.from = {from, a.triangle_of_slot[slot_using_vertex(a, farthest)]};
  result.witness.nearest = {to, b.triangle_of_slot[slot_using_vertex(b, nearest)]};
  result.witness.distance = safe_length(from - to);
  result.stats.triangles = a.triangle_count();
  result.stats.culled_on_a_percent = 100;
  return result;
}

}  // namespace meshbound
