// SPDX-License-Identifier: MIT
#pragma once
#include <optional>
#include <utility>
#include <vector>

#include "texture/overlay.h"

namespace meshbound {

/// A point of a triangle, and the candidate nearest to it.
struct FarPoint {
  Overlay::Node node;
  std::uint32_t candidate = 0;
};

/// How far a triangle A is from the candidates of its overlay at equal texture coordinates, model units.
struct TriangleDeviation {
  Bounds bounds{0, 0};          ///< of the supremum over the points of A that a candidate covers; 0 if there are none
  std::optional<FarPoint> far;  ///< where `bounds.lower` was found; absent if nothing is covered
  bool gave_up = false;         ///< `max_pieces` was reached
  std::uint64_t pieces = 0;     ///< pieces that were bounded
};

/// What `deviation_by_candidates` finds.
struct DeviationByCandidates {
  TriangleDeviation all;
  std::vector<double> uppers;  ///< by candidate: upper bound over what it covers, -1 if it covers nothing
};

/// The limits of a search, and how precise its result has to be; lengths in model units.
struct DeviationGoal {
  double lower = 0;        ///< a lower bound for the whole mesh that is known already: smaller deviations do not matter
  double error_bound = 0;  ///< an upper bound that exceeds the lower bound by no more than this suffices
  double precision = 0;    ///< of a single distance
  std::uint64_t max_pieces = 0;
};

/// An upper bound over all of A, that of the farthest candidate. Absent unless the candidates are known to cover all of
/// A. O(candidates log candidates).
[[nodiscard]] std::optional<double> upper_of_complete_cover(Overlay& overlay, double precision);

/// Bounds the deviation by each candidate alone. The distance to one candidate is convex over what it covers, so its
/// maximum is at a corner of that. Where several candidates cover the same points the upper bound is that of the
/// farthest, not the nearest one: valid, but not tight. The lower bound comes from the corners of A, or from one
/// covered point if no corner is covered. O(candidates).
[[nodiscard]] DeviationByCandidates deviation_by_candidates(Overlay& overlay, double precision);

/// Tightens what `known` says of the same overlay to the goal: by the near candidates alone if these cover all of A,
/// else by branch and bound over pieces of A, with the nearest candidate of each piece.
[[nodiscard]] TriangleDeviation deviation_by_pieces(Overlay& overlay, const DeviationByCandidates& known,
                                                    const DeviationGoal& goal);

/// The share of A that no candidate covers.
[[nodiscard]] Approximate uncovered_share(Overlay& overlay);

}  // namespace meshbound
