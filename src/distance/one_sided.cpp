// SPDX-License-Identifier: MIT
#include "distance/one_sided.h"

#include <cmath>

#include "distance/one_sided_search.h"
#include "distance/point_like.h"
#include "numeric/tasks.h"

namespace meshbound {
namespace {

void run_steps(OneSidedSearch& search, Method method) {
  if (method == Method::CrossCulling) {
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
}

}  // namespace

OneSidedDistance search_one_sided(const OneSidedTask& task) {
  const Mapping map = mapping_between(task.a.bvh->data().frame, task.a.pose, task.b.bvh->data().frame, task.b.pose);
  if (!(map.magnitude <= largest_magnitude)) return distance_to_point_like(task);
  OneSidedSearch search(task, map);
  with_team(search.threads(), [&] { run_steps(search, task.options.method); });
  search.remember_hints();
  return search.result();
}

}  // namespace meshbound
