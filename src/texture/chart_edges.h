// SPDX-License-Identifier: MIT
#pragma once
#include <span>

#include "texture/overlay.h"

namespace meshbound {

/// Sets `across` of the triangles of a mesh, whose numbers are their places here. Edges are the same where the doubles
/// of their ends and their materials are. Triangles without an area in the texture stay without. O(n log k) for k edges
/// at a texture coordinate.
void link_across_edges(std::span<ChartTriangle> triangles);

}  // namespace meshbound
