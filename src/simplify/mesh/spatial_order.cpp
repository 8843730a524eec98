// SPDX-License-Identifier: MIT
#include "simplify/mesh/spatial_order.h"

#include "bvh/bvh_data.h"

namespace meshbound {

SpatialOrder spatial_order(const TriangleMesh& mesh, const BvhOptions& options) {
  const Bvh tree(mesh, options);
  SpatialOrder order;
  order.triangle.assign(tree.data().triangle_of_slot.begin(), tree.data().triangle_of_slot.end());
  constexpr std::uint32_t unused = 0xffffffff;
  std::vector<std::uint32_t> index(mesh.vertices.size(), unused);
  order.mesh.triangles.reserve(mesh.triangles.size());
  for (const std::uint32_t t : order.triangle) {
    Triangle& corners = order.mesh.triangles.emplace_back(mesh.triangles[t]);
    for (std::uint32_t& v : corners) {
      if (index[v] == unused) {
        index[v] = static_cast<std::uint32_t>(order.vertex.size());
        order.vertex.push_back(v);
      }
      v = index[v];
    }
  }
  order.mesh.vertices.reserve(order.vertex.size());
  for (const std::uint32_t v : order.vertex) order.mesh.vertices.push_back(mesh.vertices[v]);
  return order;
}

}  // namespace meshbound
