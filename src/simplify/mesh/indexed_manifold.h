// SPDX-License-Identifier: MIT
#pragma once
#include "meshbound/triangle_mesh.h"
#include "simplify/mesh/array_mesh.h"

namespace meshbound {

/// The triangles as an array mesh, joined by the indices of their vertices: nothing is welded, dropped or turned over,
/// and all numbers stay. Vertices that no triangle uses are none of the result. Throws `InvalidInput` where that is no
/// oriented 2-manifold. O(n log n).
[[nodiscard]] ArrayMesh indexed_manifold(const TriangleMesh& mesh);

}  // namespace meshbound
