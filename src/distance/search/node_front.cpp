// SPDX-License-Identifier: MIT
#include "distance/search/node_front.h"

#include <algorithm>

#include "distance/search/node_boxes.h"
#include "distance/search/one_sided_search.h"
#include "numeric/rounding.h"

namespace meshbound {
namespace {

/// The largest motion between two steps, in units of the target, at which the front saved queries on models that
/// approach each other or move at random (tools/bench/motion).
constexpr double max_drift = 0.25;

}  // namespace

double drift_since(const NodeFront& front, const OneSidedSearch& search) {
  // The difference of two affine maps is affine, and its length convex: over a box it is largest at a corner.
  const auto before = corners_of(search.a().working_box, front.map),
             now = corners_of(search.a().working_box, search.map());
  double longest = 0;
  for (std::size_t i = 0; i < before.size(); ++i) longest = std::max(longest, length(now[i] - before[i]));
  return longest * (1 + 0x1p-40) + front.slack + search.goal().slack;
}

bool is_within(const NodeFront& front, const OneSidedSearch& search, double length) {
  if (front.nodes.empty()) return false;
  const double drift = drift_since(front, search);
  return std::all_of(front.nodes.begin(), front.nodes.end(),
                     [&](const NodeFront::Node& node) { return next_up(node.upper + drift) <= length; });
}

bool is_coherent(const NodeFront& front, const OneSidedSearch& search) {
  if (front.nodes.empty() || !(search.proven_lower() > 0)) return false;
  return drift_since(front, search) <= max_drift * search.goal().accepted(search.lower().lower);
}

}  // namespace meshbound
