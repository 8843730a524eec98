// SPDX-License-Identifier: MIT
#pragma once
#include <optional>
#include <utility>
#include <vector>

#include "texture/overlay.h"

namespace meshbound {

/// A point of a triangle, and the candidate that is nearest to it.
struct FarPoint {
  Overlay::Node node;
  std::uint32_t candidate = 0;
};

/// How far a triangle A is from the candidates of its overlay, at equal texture coordinates.
struct TriangleDeviation {
  Bounds bounds{0, 0};          ///< of the sup over the points of A that a candidate covers; 0 where there are none
  std::optional<FarPoint> far;  ///< where `bounds.lower` was found; none where nothing is covered
  bool gave_up = false;         ///< pieces ran out
  std::uint64_t pieces = 0;     ///< that were looked at
};

/// What each candidate alone says.
struct DeviationByCandidates {
  TriangleDeviation all;
  std::vector<double> uppers;  ///< by candidate, over what it covers; -1 where that is nothing
};

/// What a search may spend, and how near it has to look, model units.
struct DeviationGoal {
  double lower = 0;        ///< of the whole mesh, known before: nothing below it counts
  double error_bound = 0;  ///< upper bounds up to this above the lower bound are good enough
  double precision = 0;    ///< of single distances
  std::uint64_t max_pieces = 0;
};

/// Looks at each candidate alone, and at the corners of A, or a point that is covered where no corner is: the distance
/// to one candidate is convex over what it covers, so it is largest at a corner of that. The upper bound holds, but is
/// that of the worst candidate instead of the nearest one where several cover the same points. O(candidates).
[[nodiscard]] DeviationByCandidates deviation_by_candidates(Overlay& overlay, double precision);

/// Then takes the candidates that are near enough, where these together cover all of A; else cuts what a candidate
/// covers where others cover it as well, and takes the nearest of them: branch and bound, until the upper bound is
/// within the error bound of the lower one. `known` is what was found for the same overlay.
[[nodiscard]] TriangleDeviation deviation_by_pieces(Overlay& overlay, const DeviationByCandidates& known,
                                                    const DeviationGoal& goal);

/// The share of A that no candidate covers.
[[nodiscard]] Approximate uncovered_share(Overlay& overlay);

}  // namespace meshbound
