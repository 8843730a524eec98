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
  search.probe();
  search.drop_identical();
  search.drop_proven();
  search.cull_nodes();
  search.query_vertices();
  search.bound_triangles();
  search.walk_rest();
  search.remember_hints();
  return search.result();
}

}  // namespace meshbound
