// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/vec3.h"
#include "meshbound/triangle_mesh.h"

namespace meshbound {

/// By triangle, which triangle lies across the edge from corner k to corner k + 1: the other one of an edge that has
/// exactly two triangles, vertices at equal positions being one vertex. `no_index` for every other edge, and for all
/// edges of a triangle that has two corners at one position. Unlike the neighbours of a tree (bvh/bvh_data.h), which
/// are hints, these decide which edges are the boundary of a set of triangles. O(n log k) for k edges at a vertex.
[[nodiscard]] std::vector<std::array<std::uint32_t, 3>> edge_neighbours(std::span<const Vec3> vertices,
                                                                        std::span<const Triangle> triangles);

}  // namespace meshbound
