// SPDX-License-Identifier: MIT
#include <cmath>

#include "meshbound/report.h"

namespace meshbound {

bool was_searched(const OneSidedDistance& distance) {
  // Whether the direction was searched: a search visits at least one triangle, and the interval of a result that nobody
  // filled is [0, inf].
  return std::isfinite(distance.bounds.upper) || distance.bounds.lower > 0 || distance.stats.closest_point_queries > 0;
}

std::optional<WorstSpot> worst_spot(const Bounds& bounds, const OneSidedDistance& a_to_b,
                                    const OneSidedDistance* b_to_a) {
  const bool searched_a = was_searched(a_to_b);
  const bool searched_b = b_to_a != nullptr && was_searched(*b_to_a);
  if (!searched_a && !searched_b) return std::nullopt;
  const bool on_a = searched_a && !(searched_b && b_to_a->bounds.lower > a_to_b.bounds.lower);
  const OneSidedDistance& worse = on_a ? a_to_b : *b_to_a;
  return WorstSpot{on_a, worse.witness.from, worse.witness.nearest, {worse.bounds.lower, bounds.upper}};
}

}  // namespace meshbound
