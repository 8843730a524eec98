// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "meshbound/triangle_mesh.h"

namespace meshbound {

/// Moves vertices between the tiles of a mesh until hardly any triangle has vertices of several tiles where a tile
/// holds most of the vertices around. Planes cut through fans: a vertex in the middle of an earlier tile has a long
/// triangle to each vertex of a seam, and where the plane leaves it alone all of these triangles, and so the seam,
/// stay.
///
/// A vertex goes to the tile that most of its neighbours have, as long as that tile then weighs at most `max_weight`
/// and its own tile keeps a vertex. `owner`: by vertex, its tile or `no_index`; `weights`: by vertex. Deterministic; a
/// few rounds of O(n) for n triangles, with memory for the triangles at the borders only.
void smooth_tile_borders(std::span<const Triangle> triangles, std::span<const std::uint32_t> weights,
                         std::uint64_t max_weight, std::vector<std::uint32_t>& owner);

}  // namespace meshbound
