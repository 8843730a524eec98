// SPDX-License-Identifier: MIT
#include "distance/search/one_sided.h"

#include <algorithm>
#include <cmath>

#include "distance/search/steps.h"
#include "distance/shortcuts/point_like.h"
#include "numeric/tasks.h"

namespace meshbound {
namespace {

OneSidedDistance run_after_probe(OneSidedSearch& search, bool touches_b) {
  using Phase = PhaseSeconds;
  Remaining remaining = search.timed(&Phase::matching, [&] { return drop_identical(search, touches_b); });
  remaining = search.timed(&Phase::matching, [&] { return drop_proven(search, std::move(remaining)); });
  remaining = search.timed(&Phase::culling_on_a, [&] { return cull_nodes(search, std::move(remaining)); });
  remaining = search.timed(&Phase::culling_on_b, [&] { return sweep(search, std::move(remaining)).listed(); });
  const VertexDistances vertices =
      search.timed(&Phase::culling_on_b, [&] { return query_vertices(search, remaining); });
  std::vector<OpenTriangle> open =
      search.timed(&Phase::culling_on_b, [&] { return bound_triangles(search, remaining, vertices); });
  search.timed(&Phase::subdivision, [&] { refine(search, std::move(open)); });
  remember_hints(search, vertices);
  return search.result();
}

OneSidedDistance run_cross_culling(OneSidedSearch& search) {
  std::vector<OpenTriangle> open = search.timed(&PhaseSeconds::culling_on_a, [&] { return cross_cull(search); });
  search.timed(&PhaseSeconds::subdivision, [&] { refine(search, std::move(open)); });
  return search.result();
}

bool run_probe(OneSidedSearch& search) {
  return search.timed(&PhaseSeconds::culling_on_a, [&] { return probe(search); });
}

Mapping mapping_of(const OneSidedTask& task) {
  return mapping_between(task.a.bvh->data().frame, task.a.pose, task.b.bvh->data().frame, task.b.pose);
}

/// The direction from B comes first where a few vertices of B are so many times further from A than those of A from B:
/// smaller ratios of so few points tell too little.
constexpr double clearly_further = 2;

bool fits_frame(const Mapping& map) { return map.magnitude <= max_magnitude; }

/// Measures the distance to a B that is a point, or tiny beside A or its distance from A.
OneSidedDistance search_point_like(const OneSidedTask& task) {
  OneSidedDistance result = distance_to_point_like(task.a, task.b);
  const auto [lower, upper] = result.bounds;
  const bool wanted = task.decide_only ? upper <= task.tolerance : upper - lower <= task.error_bound;
  result.outcome = wanted ? Outcome::Converged : Outcome::PrecisionReached;
  if (task.decide_only && lower > task.tolerance) result.outcome = Outcome::ExceedsTolerance;
  result.stats.seconds = seconds_since(task.start);
  return result;
}

}  // namespace

OneSidedDistance search_one_sided(const OneSidedTask& task) {
  const Mapping map = mapping_of(task);
  if (!fits_frame(map)) return search_point_like(task);
  OneSidedSearch search(task, map);
  OneSidedDistance result;
  with_team(search.threads(), [&] {
    result = task.options.method == Method::CrossCulling ? run_cross_culling(search)
                                                         : run_after_probe(search, run_probe(search));
  });
  return result;
}

OneSidedDistance bound_by_vertices(const OneSidedTask& task) {
  const Mapping map = mapping_of(task);
  OneSidedDistance result;
  if (fits_frame(map)) {
    OneSidedSearch search(task, map);
    with_team(search.threads(), [&] {
      (void)query_vertices(search, Remaining(search.a().triangle_count()));
      result = search.result();
    });
  }
  result.bounds.upper = std::numeric_limits<double>::infinity();
  return result;
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
    const bool forward_touches = run_probe(there), back_touches = run_probe(here);
    const double seen_there = there.proven_lower(), seen_here = here.proven_lower();
    if (seen_here > clearly_further * seen_there) {
      results.second = run_after_probe(here, back_touches);
      there.raise_known_lower(results.second.bounds.lower);
      results.first = run_after_probe(there, forward_touches);
    } else {
      there.raise_known_lower(seen_here);
      results.first = run_after_probe(there, forward_touches);
      here.raise_known_lower(results.first.bounds.lower);
      results.second = run_after_probe(here, back_touches);
    }
  });
  return results;
}

}  // namespace meshbound
