// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "meshbound/mesh_view.h"
#include "meshbound/triangle_mesh.h"
#include "numeric/no_index.h"
#include "proof/edge_neighbours.h"

namespace meshbound {

/// A triangle soup as an oriented 2-manifold with borders: a corner table. Corner k of face f has the number 3 f + k,
/// and so has the edge that leaves it for corner k + 1.
///
/// Twins are mutual, run between the same two vertices in opposite directions, and are exactly the pairs of edges that
/// do so: no two edges run from one vertex to another, as in a half-edge structure. The faces around a vertex form one
/// fan or one ring, and every vertex has a face.
struct ManifoldSoup {
  /// A triangle that was dropped, for it has the corners of one that was not.
  struct Repetition {
    std::uint32_t triangle, of;
  };
  std::vector<Triangle> faces;                     ///< corners as indices below `vertex_of.size()`
  std::vector<std::array<std::uint32_t, 3>> twin;  ///< by face and corner: the opposite edge, `no_index` at a border
  std::vector<std::uint32_t> vertex_of;    ///< by vertex: the first vertex of the soup with its coordinates (-0 is 0)
  std::vector<std::uint32_t> triangle_of;  ///< by face: the triangle of the soup, ascending
  std::vector<Repetition> repetitions;
  std::size_t dropped_triangles = 0;  ///< those with two corners of equal coordinates, and repetitions
  bool split = false;                 ///< vertices were duplicated or triangles turned over
};

/// Joins the triangles of a soup where they form a surface. Vertices with equal coordinates are one. An edge of exactly
/// two triangles joins them, whatever their directions. So does an edge of more, where all but two are so flat that
/// they have no angle around it; where as many of those with an angle run upward as downward, it joins them in pairs
/// that do not cross (see `pairs_around_edge`), so that closed solids which touch along edges stay closed. Else it is
/// cut, but for triangles that hang together around both of its ends. Triangles are then turned over until neighbours
/// agree: each component keeps the orientation of most of its triangles, or that of the first one where there are as
/// many of both, and is cut where none is possible (Moebius). Last, a vertex is duplicated for each further fan or ring
/// of faces around it. Vertices are numbered as the corners of the faces come, and a face that is turned over keeps its
/// first corner.
///
/// `look` is empty or has a number for each triangle: only repetitions with equal numbers that face the same way are
/// dropped. Those that differ, as a decal does from what it lies on, or the back of a sheet from its front, are kept on
/// sheets of their own: triangles of different sheets are not joined, and the first triangle of each set of corners is
/// on the first sheet.
///
/// `number` is empty or has a different number for each triangle, which says what comes first among triangles with the
/// same corners: the one with the lowest number stays of repetitions, and sheets are numbered in this order. Without
/// numbers it is the order of the soup. Where that is another one than the caller's, as along a space-filling curve,
/// the caller's numbers keep fronts on one sheet and backs on another: a curve may meet either of both first.
///
/// `at_rim` is empty or says of each vertex whether `soup` may lack triangles that have it, as a tile of a larger mesh
/// does at its rim. Two triangles of an edge between such vertices may be some of many: they are joined only where they
/// run along it in opposite directions, so that what closes a solid is not turned over.
///
/// `soup` is valid (see `validate`). Without faces where no triangle has three different corners. Throws `InvalidInput`
/// for more than 2^32 / 3 triangles. Deterministic; O(n log d) expected time for d edges at a vertex, O(n) memory.
[[nodiscard]] ManifoldSoup manifold_soup(const MeshView& soup, std::span<const std::uint32_t> look = {});

/// The same, in less time, where the first vertex at the position of each vertex and the neighbours of each triangle
/// are known, those that a tree has found (see `edge_neighbours`): edges are sorted only where these are not certain.
[[nodiscard]] ManifoldSoup manifold_soup(const MeshView& soup, std::vector<std::uint32_t> first_at_position,
                                         std::span<const TriangleNeighbours> neighbours,
                                         std::span<const std::uint32_t> look,
                                         std::span<const std::uint32_t> number = {},
                                         const std::vector<bool>& at_rim = {});

}  // namespace meshbound
