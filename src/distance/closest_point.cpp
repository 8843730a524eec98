// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "bvh/bvh_data.h"
#include "distance/point_like.h"
#include "distance/searcher.h"
#include "meshbound/error.h"
#include "numeric/rounding.h"

namespace meshbound {
namespace {

double largest(const Vec3& v) { return std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)}); }

Eigen::Vector3d to_eigen(const Vec3& v) { return {v.x, v.y, v.z}; }

/// The mesh is a point beside its distance: see `distance_to_point_like`.
ClosestPoint closest_of_point_like(const Bvh::Data& data, const Eigen::Vector3d& query) {
  const Eigen::Vector3d point = to_eigen(data.frame.to_model(data.vertices[0]));
  const Eigen::Vector3d apart = query - point;
  const double distance = std::hypot(apart.x(), apart.y(), apart.z());
  const double reach = std::max(query.cwiseAbs().maxCoeff(), point.cwiseAbs().maxCoeff());
  const double slack = 32 * unit_roundoff * reach + data.diagonal * (1 + 4 * unit_roundoff);
  return {{point, data.triangle_of_slot[0]}, {std::max(0.0, next_down(distance - slack)), next_up(distance + slack)}};
}

}  // namespace

ClosestPoint closest_point(const Bvh& bvh, const Eigen::Vector3d& query) {
  if (!query.allFinite() || query.cwiseAbs().maxCoeff() > largest_coordinate)
    throw InvalidInput("the query point has a coordinate that is not finite or is beyond 2^1000");
  const Bvh::Data& data = bvh.data();
  const Vec3 model{query.x(), query.y(), query.z()};
  const Vec3 p = data.frame.to_working(model);
  const double magnitude = std::max(1.0, largest(p));
  if (!(magnitude <= largest_magnitude)) return closest_of_point_like(data, query);
  Goal goal;
  set_slack(goal, magnitude, data.frame.error + data.frame.rounding_of(model));
  const std::unique_ptr<Searcher> searcher = make_searcher(data, goal);
  const Nearest nearest = searcher->nearest(p, 0, 0);
  searcher->begin({});
  searcher->offer(p, nearest, 0);
  const CornerTriangle<double> t = triangle_at(data, nearest.slot);
  ClosestPoint result;
  result.point = {to_eigen(data.frame.to_model(p - closest_on_triangle(t, p).offset)),
                  data.triangle_of_slot[nearest.slot]};
  result.distance.lower = data.frame.length_down(std::max(0.0, searcher->lower().lower));
  const double upper = next_up(std::sqrt(nearest.squared) * (1 + 4 * unit_roundoff)) + goal.slack;
  result.distance.upper = data.frame.length_up(upper);
  return result;
}

}  // namespace meshbound
