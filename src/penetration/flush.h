// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <vector>

#include "penetration/curves.h"
#include "penetration/pieces.h"

namespace meshbound {

/// The intersection of a triangle of each side, both in one plane with normals to the same side. Both surfaces bound
/// the volume there, but the perturbation gives this face to one side only; the record adds it to the other one.
struct FlushFace {
  std::uint32_t side = 0;            ///< the side that lacks the face
  std::uint32_t triangle = 0;        ///< of that side
  std::uint32_t piece = 0;           ///< of the other side, which has the face
  std::vector<PieceCorner> corners;  ///< of a convex polygon
};

/// Finds all such faces and adds their corners to `flush_corners` of the curves. Exact.
[[nodiscard]] std::vector<FlushFace> find_flush_faces(PlacedPair& pair, CrossingCurves& curves, const Pieces& pieces);

}  // namespace meshbound
