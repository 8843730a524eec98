// SPDX-License-Identifier: MIT
#pragma once
#include "simplify/mesh/spatial_order.h"

namespace meshbound::test {

/// The mesh as a decimation orders it.
inline TriangleMesh spatially_ordered(const TriangleMesh& mesh) {
  const SpatialOrder order = spatial_order(mesh, {1});
  TriangleMesh ordered{{}, order.triangles};
  for (const std::uint32_t v : order.vertex) ordered.vertices.push_back(mesh.vertices[v]);
  return ordered;
}

}  // namespace meshbound::test
