// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/vec3.h"
#include "meshbound/bvh.h"
#include "meshbound/triangle_mesh.h"

namespace meshbound {

/// By triangle.
using TriangleNeighbours = std::array<std::uint32_t, 3>;

/// By triangle, which triangle lies across the edge from corner k to corner k + 1: the other one of an edge that has
/// exactly two triangles, vertices at equal positions being one vertex. `no_index` for every other edge, and for all
/// edges of a triangle that has two corners at one position. Unlike the neighbours of a tree (bvh/bvh_data.h), which
/// are hints, these decide which edges are the boundary of a set of triangles. O(n log k) for k edges at a vertex.
[[nodiscard]] std::vector<TriangleNeighbours> edge_neighbours(std::span<const Vec3> vertices,
                                                              std::span<const Triangle> triangles);

/// The same by the hints of a tree of these triangles, each of which is checked; several times as fast. Where more than
/// two triangles have an edge, those that share its vertices by their indices, and are two, are neighbours here. Either
/// way an edge of a triangle has one partner at most, whose partner it is: the edges between the triangles of a set
/// come in pairs, which is what a parity proof relies on. O(n).
[[nodiscard]] std::vector<TriangleNeighbours> edge_neighbours(const Bvh& tree, std::span<const Vec3> vertices,
                                                              std::span<const Triangle> triangles);

}  // namespace meshbound
