// SPDX-License-Identifier: MIT
#include "simplify/mesh/spatial_order.h"

#include "bvh/bvh_data.h"
#include "mesh/first_use.h"

namespace meshbound {

SpatialOrder spatial_order(const TriangleMesh& mesh, const BvhOptions& options) {
  const Bvh tree(mesh, options);
  SpatialOrder order;
  order.triangle.assign(tree.data().triangle_of_slot.begin(), tree.data().triangle_of_slot.end());
  FirstUse number(mesh.vertices.size());
  order.mesh.triangles.reserve(mesh.triangles.size());
  for (const std::uint32_t t : order.triangle) order.mesh.triangles.push_back(number(mesh.triangles[t]));
  order.vertex = number.used();
  order.mesh.vertices.reserve(order.vertex.size());
  for (const std::uint32_t v : order.vertex) order.mesh.vertices.push_back(mesh.vertices[v]);
  return order;
}

}  // namespace meshbound
