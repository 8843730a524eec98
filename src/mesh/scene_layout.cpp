// SPDX-License-Identifier: MIT
#include "mesh/scene_layout.h"

#include <Eigen/LU>

namespace meshbound {

bool NodePlacement::is_mirrored() const { return linear.determinant() < 0; }

bool NodePlacement::is_invertible() const {
  const Eigen::Matrix3d inverse = linear.inverse();
  return linear.determinant() != 0 && inverse.allFinite();
}

/// Written out as three products added from the left, as are products of placements, so that every reader of the file
/// computes the same bits (tools/schema/certificate-1.md).
Eigen::Vector3d NodePlacement::to_scene(const Eigen::Vector3d& p) const {
  if (is_identity()) return p;
  Eigen::Vector3d q;
  for (Eigen::Index i = 0; i < 3; ++i)
    q[i] = linear(i, 0) * p[0] + linear(i, 1) * p[1] + linear(i, 2) * p[2] + translation[i];
  return q;
}

Eigen::Vector3d NodePlacement::to_node(const Eigen::Vector3d& p) const {
  if (is_identity()) return p;
  const Eigen::Vector3d moved = p - translation;
  return linear.inverse() * moved;
}

NodePlacement NodePlacement::operator*(const NodePlacement& inner) const {
  NodePlacement result;
  for (Eigen::Index i = 0; i < 3; ++i)
    for (Eigen::Index j = 0; j < 3; ++j)
      result.linear(i, j) =
          linear(i, 0) * inner.linear(0, j) + linear(i, 1) * inner.linear(1, j) + linear(i, 2) * inner.linear(2, j);
  result.translation = to_scene(inner.translation);
  return result;
}

}  // namespace meshbound
