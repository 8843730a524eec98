// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "penetration/piece_plane.h"

namespace meshbound {

/// Cuts a polygon, given by the lines around it and around its holes in any order, into triangles of its corners by
/// ears (Meisters, "Polygons have ears", Amer. Math. Monthly 82(6), 1975); bridges connect holes to what is around
/// them. Appends to `triangles`.
///
/// The triangles form a disc whose border is that of the polygon and each bridge twice, there and back. So every point
/// with a winding number other than 0 is in one of them, whatever choices were made: they cover the polygon. If no
/// triangle is turned over, no point with winding number 0 is in one: they cover nothing else. Turns are decided
/// exactly. In that case the result is 0; else it is a length, local, that bounds how far the triangles reach outside
/// the polygon: the longest edge of those that had to be turned over, whose corners are in the polygon.
[[nodiscard]] double triangulate(const PiecePlane& plane, std::span<const std::span<const PieceCorner>> border,
                                 std::vector<CornerTriple>& triangles);

}  // namespace meshbound
