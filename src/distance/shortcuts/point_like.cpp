// SPDX-License-Identifier: MIT
#include "distance/shortcuts/point_like.h"

#include <algorithm>
#include <cmath>

#include "bvh/bvh_data.h"
#include "distance/shortcuts/identical.h"
#include "numeric/rounding.h"

namespace meshbound {
namespace {

Eigen::Vector3d world(const PlacedModel& model, const Vec3& working) {
  const Vec3 p = model.bvh->data().frame.to_model(working);
  return model.pose * Eigen::Vector3d(p.x, p.y, p.z);
}

double safe_length(const Eigen::Vector3d& v) { return std::hypot(v.x(), v.y(), v.z()); }

}  // namespace

OneSidedDistance distance_to_point_like(const PlacedModel& placed_a, const PlacedModel& placed_b) {
  const Bvh::Data& a = placed_a.bvh->data();
  const Bvh::Data& b = placed_b.bvh->data();
  const Eigen::Vector3d centre = world(placed_b, b.vertices[0]);
  OneSidedDistance result;
  std::uint32_t farthest = 0;
  double distance = -1, reach = safe_length(centre);
  for (std::uint32_t v = 0; v < a.vertices.size(); ++v) {
    const Eigen::Vector3d p = world(placed_a, a.vertices[v]);
    reach = std::max(reach, safe_length(p));
    if (const double d = safe_length(p - centre); d > distance) {
      distance = d;
      farthest = v;
    }
  }
  // Two poses (6 roundings a coordinate each, 1e-9 of drift refused elsewhere), a difference and a hypot: 32 u of the
  // largest length in sight; the diagonal of B, stretched by what a pose may drift (below 2^-29), bounds how far B
  // reaches from one of its own vertices.
  const double size_of_b = b.diagonal * (1 + 0x1p-28);
  const double slack = 32 * unit_roundoff * reach + size_of_b;
  result.bounds = {std::max(0.0, next_down(distance - slack)), next_up(distance + slack)};
  result.witness.from = {world(placed_a, a.vertices[farthest]), a.triangle_of_slot[slot_using_vertex(a, farthest)]};
  result.witness.nearest = {centre, b.triangle_of_slot[0]};
  result.witness.distance = distance;
  result.stats.triangles = a.triangle_count();
  result.stats.culled_on_a_percent = 100;
  return result;
}

}  // namespace meshbound
