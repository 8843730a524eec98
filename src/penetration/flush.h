// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <vector>

#include "penetration/curves.h"
#include "penetration/pieces.h"

namespace meshbound {

/// What a triangle of each side have in common, where both lie in one plane with their normals on the same side. Both
/// surfaces bound the intersection there, but the perturbation gives it to one of them; this is for the other.
struct FlushFace {
  std::uint32_t side = 0;            ///< that lacks it
  std::uint32_t triangle = 0;        ///< of that side
  std::uint32_t piece = 0;           ///< of the other side, which holds it
  std::vector<PieceCorner> corners;  ///< of a convex polygon
};

/// All of them; adds their corners to `flush_corners` of the curves. Exact.
[[nodiscard]] std::vector<FlushFace> find_flush_faces(PlacedPair& pair, CrossingCurves& curves, const Pieces& pieces);

}  // namespace meshbound
