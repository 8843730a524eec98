// SPDX-License-Identifier: MIT
#include "distance/one_sided.h"

#include <cmath>

#include "distance/one_sided_search.h"
#include "distance/point_like.h"

namespace meshbound {

OneSidedDistance search_one_sided(const OneSidedTask& task) {
  const Mapping map = mapping_between(task.a.bvh->data().frame, task.a.pose, task.b.bvh->data().frame, task.b.pose);
  if (!(map.magnitude <= largest_magnitude)) return distance_to_point_like(task);
  OneSidedSearch search(task, map);
  if (task.options.method == Method::CrossCulling) {
    search.run(&OneSidedSearch::cross_cull, &PhaseSeconds::culling_on_a);
  } else {
    search.run(&OneSidedSearch::probe, &PhaseSeconds::culling_on_a);
    search.run(&OneSidedSearch::drop_identical, &PhaseSeconds::matching);
    search.run(&OneSidedSearch::drop_proven, &PhaseSeconds::matching);
    search.run(&OneSidedSearch::cull_nodes, &PhaseSeconds::culling_on_a);
    search.run(&OneSidedSearch::sweep, &PhaseSeconds::culling_on_b);
    search.run(&OneSidedSearch::query_vertices, &PhaseSeconds::culling_on_b);
    search.run(&OneSidedSearch::bound_triangles, &PhaseSeconds::culling_on_b);
  }
  search.run(&OneSidedSearch::refine_rest, &PhaseSeconds::subdivision);
  search.remember_hints();
  return search.result();
}

}  // namespace meshbound
