// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "meshbound/triangle_mesh.h"

namespace meshbound {

/// An edge of a mesh by the indices of its two vertices.
using Edge = std::array<std::uint32_t, 2>;

/// Edges of a mesh as a mesh of triangles without area, one for each, so that the distance between lines is measured
/// like that between surfaces: `hausdorff_distance(line_mesh(a, edges_of_a), line_mesh(b, edges_of_b))`. Vertices that
/// no edge uses are left out, the others keep their order and coordinates. Throws `InvalidInput` for an index out of
/// range. O(n).
[[nodiscard]] TriangleMesh line_mesh(const TriangleMesh& mesh, std::span<const Edge> edges);

}  // namespace meshbound
