// SPDX-License-Identifier: MIT
#pragma once
#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>

#include "meshbound/stop_token.h"
#include "texture/covering.h"
#include "texture/overlay.h"

namespace meshbound {

/// A point of a triangle, and the candidate nearest to it.
struct FarPoint {
  Overlay::Node node;
  std::uint32_t candidate = 0;
};

/// How far a triangle A is from the triangles of the other mesh at equal texture coordinates, model units.
struct TriangleDeviation {
  /// Bounds of the supremum over the points of A that the other mesh covers; an upper bound of -1: none is covered.
  Bounds bounds{0, -1};
  std::optional<FarPoint>
      far;                ///< where `bounds.lower` was found; absent where no point was looked at, or none is covered
  Approximate uncovered;  ///< the share of A that the other mesh does not cover
  bool gave_up = false;   ///< `max_pieces` was reached
  std::uint64_t pieces = 0;  ///< pieces that were bounded
};

/// The limits of a search, and how precise its result has to be; lengths in model units.
struct DeviationGoal {
  double lower = 0;        ///< a lower bound for the whole mesh that is known already: smaller deviations do not matter
  double min_upper = 0;    ///< upper bounds below it are not told apart
  double error_bound = 0;  ///< an upper bound that exceeds the lower bound by no more than this suffices
  double precision = 0;    ///< of a single distance
  /// A larger upper bound comes with a far point; a larger lower bound ends the search: any upper bound suffices.
  double silent = HUGE_VAL;
  std::uint64_t max_pieces = 0;
  /// Where A has no area in the texture: the others are farther than this from every point of A.
  double reach = 0;
  StopToken stop;  ///< looked at between pieces; the search throws as it says
};

/// Finds all triangles that may have texture coordinates of A, beside the likely candidates.
using FindOthers = std::function<std::span<const ChartTriangle* const>()>;

/// Bounds the deviation to the goal by branch and bound over pieces of A. The overlay holds the likely candidates; the
/// others are found once, where those do not suffice, and join it.
[[nodiscard]] TriangleDeviation deviation_by_pieces(Overlay& overlay, Covering& covering, const FindOthers& find_others,
                                                    const DeviationGoal& goal);

/// A far point of a triangle without a search: the farthest of its corners, or a point that the other mesh covers where
/// no corner is. Only the lower bound and the point of the result are set.
[[nodiscard]] TriangleDeviation deviation_at_corners(Overlay& overlay, const FindOthers& find_others,
                                                     const DeviationGoal& goal);

}  // namespace meshbound
