// SPDX-License-Identifier: MIT
#include "distance/distance_stats.h"

#include <algorithm>

namespace meshbound {

void add(DistanceStats& sum, const DistanceStats& stats) {
  sum.triangles += stats.triangles;
  sum.matched += stats.matched;
  sum.proven_before += stats.proven_before;
  sum.culled_by_node += stats.culled_by_node;
  sum.culled_by_vertices += stats.culled_by_vertices;
  sum.walked += stats.walked;
  sum.closest_point_queries += stats.closest_point_queries;
  sum.nodes_visited += stats.nodes_visited;
  sum.triangles_tested += stats.triangles_tested;
  sum.subdivisions += stats.subdivisions;
  sum.deepest_subdivision = std::max(sum.deepest_subdivision, stats.deepest_subdivision);
  sum.pieces += stats.pieces;
  sum.resolved += stats.resolved;
  sum.enclosed += stats.enclosed;
  sum.given_up += stats.given_up;
  sum.phases.matching += stats.phases.matching;
  sum.phases.culling_on_a += stats.phases.culling_on_a;
  sum.phases.culling_on_b += stats.phases.culling_on_b;
  sum.phases.subdivision += stats.phases.subdivision;
}

}  // namespace meshbound
