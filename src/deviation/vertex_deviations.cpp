// SPDX-License-Identifier: MIT
#include "deviation/measure_points.h"
#include "meshbound/deviation_map.h"

namespace meshbound {

std::vector<Bounds> vertex_deviations(const MeshView& mesh, const Bvh& other, const DeviationOptions& options) {
  validate(mesh);
  std::vector<Eigen::Vector3d> points;
  std::vector<std::size_t> vertex_of_point;
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    const Eigen::Vector3d p = mesh.vertex(v);
    if (!p.allFinite() || p.cwiseAbs().maxCoeff() > largest_coordinate) continue;  // no triangle uses it
    points.push_back(p);
    vertex_of_point.push_back(v);
  }
  std::vector<Bounds> deviations(mesh.vertex_count());
  measure_points(points, other, options,
                 [&](std::size_t i, const ClosestPoint& found) { deviations[vertex_of_point[i]] = found.distance; });
  return deviations;
}

}  // namespace meshbound
