// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <utility>
#include <vector>

#include "meshbound/distance.h"
#include "meshbound/stop_token.h"

namespace meshbound {

struct SearchMemory;

/// One direction of a measurement: what all directions and levels share.
struct OneSidedTask {
  const PlacedModel& a;
  const PlacedModel& b;
  double error_bound = 0;                                      ///< model units
  double tolerance = std::numeric_limits<double>::infinity();  ///< model units; infinite: none
  bool decide_only = false;
  /// A lower bound already known of the quantity that is wanted (the other direction's, paper section 6): points nearer
  /// than this need no bound of their own. The result's `lower` may then be below it, its `upper` is at most the
  /// larger.
  double known_lower = 0;
  /// Closest pairs cached between the directions (paper, section 6), both ways hints: a triangle of B for each triangle
  /// of A or `no_slot`, by slot; and room for the pairs that this direction finds, a triangle of A for each of B.
  const std::vector<std::uint32_t>* known_pairs = nullptr;
  std::vector<std::uint32_t>* found_pairs = nullptr;
  const DistanceOptions& options;
  SearchMemory* memory = nullptr;  ///< proofs and hints of earlier searches, used and updated; null: none
  StopToken::Clock::time_point start = StopToken::Clock::now();
};

OneSidedDistance search_one_sided(const OneSidedTask& task);

/// A lower bound alone, by the vertices of A, at a fifth of the cost of a search; in a decision it ends with the first
/// one beyond the tolerance. The upper bound of the result is infinite, its outcome says nothing.
OneSidedDistance bound_by_vertices(const OneSidedTask& task);

/// Both directions, of which `back` is the reverse of `forward`, the reverse first where a few vertices show that it is
/// clearly further: the lower bound of the first is known to the other (paper, section 6). Results as
/// `search_one_sided` gives them.
std::pair<OneSidedDistance, OneSidedDistance> search_both(const OneSidedTask& forward, const OneSidedTask& back);

}  // namespace meshbound
