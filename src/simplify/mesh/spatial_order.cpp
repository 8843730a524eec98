// SPDX-License-Identifier: MIT
#include "simplify/mesh/spatial_order.h"

#include "bvh/build.h"
#include "mesh/first_use.h"

namespace meshbound {

SpatialOrder spatial_order(const TriangleMesh& mesh, const BvhOptions& options) {
  SpatialOrder order;
  order.triangle = triangles_along_curve(mesh, options);
  FirstUse number(mesh.vertices.size());
  order.triangles.reserve(mesh.triangles.size());
  for (const std::uint32_t t : order.triangle) order.triangles.push_back(number(mesh.triangles[t]));
  order.vertex = number.used();
  return order;
}

}  // namespace meshbound
