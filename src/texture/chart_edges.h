// SPDX-License-Identifier: MIT
#pragma once
#include <span>

#include "texture/overlay.h"

namespace meshbound {

/// Sets `across` of the triangles of a mesh, whose numbers are their places here: neighbours in space, at edges of two
/// triangles, whose common edge has the same ends in the texture and lies between them there too, and that have the
/// same material. Charts may lie on one another in the texture: each has its own neighbours. An edge has one partner at
/// most, whose partner it is. Triangles without an area in the texture stay without. O(n log k) for k edges at a
/// vertex.
void link_across_edges(std::span<ChartTriangle> triangles);

}  // namespace meshbound
