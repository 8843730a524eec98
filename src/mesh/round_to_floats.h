// SPDX-License-Identifier: MIT
#pragma once
#include "meshbound/triangle_mesh.h"
#include "numeric/rounded_to_float.h"

namespace meshbound {

/// The point with the nearest floats as coordinates.
[[nodiscard]] inline Eigen::Vector3d rounded_to_float(const Eigen::Vector3d& p) {
  return {rounded_to_float(p.x()), rounded_to_float(p.y()), rounded_to_float(p.z())};
}

/// Rounds the coordinates of all vertices to the nearest floats.
inline void round_to_floats(TriangleMesh& mesh) {
  for (Eigen::Vector3d& p : mesh.vertices) p = rounded_to_float(p);
}

}  // namespace meshbound
