// SPDX-License-Identifier: MIT
#include "distance/search/one_sided.h"

#include <algorithm>
#include <cmath>

#include "distance/search/one_sided_search.h"
#include "distance/shortcuts/point_like.h"
#include "numeric/tasks.h"

namespace meshbound {
namespace {

void run_after_probe(OneSidedSearch& search) {
  search.run(&OneSidedSearch::drop_identical, &PhaseSeconds::matching);
  search.run(&OneSidedSearch::drop_proven, &PhaseSeconds::matching);
  search.run(&OneSidedSearch::cull_nodes, &PhaseSeconds::culling_on_a);
  search.run(&OneSidedSearch::sweep, &PhaseSeconds::culling_on_b);
  search.run(&OneSidedSearch::query_vertices, &PhaseSeconds::culling_on_b);
  search.run(&OneSidedSearch::bound_triangles, &PhaseSeconds::culling_on_b);
  search.run(&OneSidedSearch::refine_rest, &PhaseSeconds::subdivision);
}

void run_steps(OneSidedSearch& search, Method method) {
  if (method == Method::CrossCulling) {
    search.run(&OneSidedSearch::cross_cull, &PhaseSeconds::culling_on_a);
    search.run(&OneSidedSearch::refine_rest, &PhaseSeconds::subdivision);
  } else {
    search.run(&OneSidedSearch::probe, &PhaseSeconds::culling_on_a);
    run_after_probe(search);
  }
}

OneSidedDistance finish(OneSidedSearch& search) {
  run_after_probe(search);
  search.remember_hints();
  return search.result();
}

Mapping mapping_of(const OneSidedTask& task) {
  return mapping_between(task.a.bvh->data().frame, task.a.pose, task.b.bvh->data().frame, task.b.pose);
}

/// How many times further a few vertices of B must be for its direction to come first: below it they tell too little.
constexpr double clearly_further = 2;

bool fits_frame(const Mapping& map) { return map.magnitude <= largest_magnitude; }

/// B is a point, or tiny beside A or its distance from it.
OneSidedDistance search_point_like(const OneSidedTask& task) {
  OneSidedDistance result = distance_to_point_like(task.a, task.b);
  const auto [lower, upper] = result.bounds;
  const bool wanted = task.decide_only ? upper <= task.tolerance : upper - lower <= task.error_bound;
  result.outcome = wanted ? Outcome::Converged : Outcome::PrecisionReached;
  if (task.decide_only && lower > task.tolerance) result.outcome = Outcome::ExceedsTolerance;
  result.stats.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - task.start).count();
  return result;
}

}  // namespace

OneSidedDistance search_one_sided(const OneSidedTask& task) {
  const Mapping map = mapping_of(task);
  if (!fits_frame(map)) return search_point_like(task);
  OneSidedSearch search(task, map);
  with_team(search.threads(), [&] { run_steps(search, task.options.method); });
  search.remember_hints();
  return search.result();
}

std::pair<OneSidedDistance, OneSidedDistance> search_both(const OneSidedTask& forward, const OneSidedTask& back) {
  const Mapping forward_map = mapping_of(forward), back_map = mapping_of(back);
  if (forward.options.method == Method::CrossCulling || !fits_frame(forward_map) || !fits_frame(back_map)) {
    OneSidedDistance first = search_one_sided(forward);
    OneSidedTask seeded = back;
    seeded.known_lower = first.bounds.lower;
    return {std::move(first), search_one_sided(seeded)};
  }
  OneSidedSearch there(forward, forward_map), here(back, back_map);
  std::pair<OneSidedDistance, OneSidedDistance> results;
  with_team(there.threads(), [&] {
    there.run(&OneSidedSearch::probe, &PhaseSeconds::culling_on_a);
    here.run(&OneSidedSearch::probe, &PhaseSeconds::culling_on_a);
    const double seen_there = there.proven_lower(), seen_here = here.proven_lower();
    if (seen_here > clearly_further * seen_there) {
      results.second = finish(here);
      there.raise_known_lower(results.second.bounds.lower);
      results.first = finish(there);
    } else {
      there.raise_known_lower(seen_here);
      results.first = finish(there);
      here.raise_known_lower(results.first.bounds.lower);
      results.second = finish(here);
    }
  });
  return results;
}

}  // namespace meshbound
