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

/// The triangles across the edges of one triangle, [k] across the edge from corner k to corner k + 1.
using TriangleNeighbours = std::array<std::uint32_t, 3>;

/// Whether two different triangles lie across edges of one that have no third triangle: a triangle with the same three
/// corners would lie across both edges, so there is none.
[[nodiscard]] bool lies_between_two(const TriangleNeighbours& neighbours);

/// By triangle, which triangle lies across the edge from corner k to corner k + 1: the other one of an edge that has
/// exactly two triangles, vertices at equal positions being one vertex. `no_index` for every other edge, and for all
/// edges of a triangle that has two corners at one position. Unlike the neighbours of a tree (bvh/bvh_data.h), which
/// are hints, these decide which edges are the boundary of a set of triangles. O(n log k) for k edges at a vertex.
[[nodiscard]] std::vector<TriangleNeighbours> edge_neighbours(std::span<const Vec3> vertices,
                                                              std::span<const Triangle> triangles);

/// The neighbours that `tree`, built of these triangles, has found; each pair is checked by the positions of its
/// corners. Differs from the function above at edges of more than two triangles only: two of them that have the edge's
/// vertices for themselves, by index, may be neighbours here. Both functions give an edge of a triangle one partner at
/// most, whose partner it is, so that the edges inside a set of triangles come in pairs: a parity proof relies on that.
/// O(n), shared by the threads.
[[nodiscard]] std::vector<TriangleNeighbours> edge_neighbours(const Bvh& tree, std::span<const Vec3> vertices,
                                                              std::span<const Triangle> triangles, int threads = 1);

}  // namespace meshbound
