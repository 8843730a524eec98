// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "penetration/piece_plane.h"

namespace meshbound {

using CornerTriple = std::array<PieceCorner, 3>;

/// Cuts a polygon with holes into triangles of its corners by ears (Meisters, "Polygons have ears", Amer. Math. Monthly
/// 82(6), 1975), holes joined to what is around them by bridges. Appends to `triangles`.
///
/// The triangles make a disc whose border is that of the polygon, bridges there and back. So every point that the
/// border winds around is in one of them, whatever choices were made: they cover the polygon. Where no triangle is
/// turned over, a point that the border does not wind around is in none: they cover nothing else. Turns are decided
/// exactly. Returns 0 then; else a length, local, that no point of a triangle is further from the polygon: the longest
/// edge of those that had to be turned over, as their corners are in the polygon.
[[nodiscard]] double triangulate(const PiecePlane& plane, std::span<const PieceCorner> outer,
                                 const std::vector<std::span<const PieceCorner>>& holes,
                                 std::vector<CornerTriple>& triangles);

}  // namespace meshbound
