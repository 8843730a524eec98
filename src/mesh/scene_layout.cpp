// SPDX-License-Identifier: MIT
#include "mesh/scene_layout.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <map>

namespace meshbound {
namespace {

/// A vertex that moves by d across the direction in which a placement stretches least moves by d / smallest in the
/// frame of the node. Rounding to a float there, 2^-24 of that, comes back as 2^-24 largest / smallest d. From this
/// ratio on, that is less than d / 16, so that what is written stays near what was proven.
constexpr double min_stretch_ratio = 0x1p-20;

/// The most by which the errors of a coordinate of the scene may be enlarged in the frame of the node, relative to the
/// size of the mesh: 2^-53 becomes less than a float's 2^-24 then, with room for the few roundings of the map.
constexpr double max_enlargement = 0x1p26;

/// The factors by which a placement stretches, descending.
Eigen::Vector3d stretches(const NodePlacement& placement) {
  return Eigen::JacobiSVD<Eigen::Matrix3d>(placement.linear).singularValues();
}

/// By how much inverting the placement of a mesh enlarges relative errors: its largest coordinate in the scene by its
/// smallest extent there.
double enlargement(const PlacedMesh& placed) {
  const Eigen::Vector3d stretch = stretches(placed.placement);
  const double far = placed.placement.translation.norm() + stretch[0] * placed.reach;
  return placed.reach > 0 ? far / (stretch[2] * placed.reach) : 0;
}

}  // namespace

bool NodePlacement::is_mirrored() const { return linear.determinant() < 0; }

bool NodePlacement::is_invertible() const {
  if (linear.determinant() == 0 || !linear.inverse().allFinite()) return false;
  const Eigen::Vector3d stretch = stretches(*this);
  return stretch[2] >= min_stretch_ratio * stretch[0];
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

std::vector<std::uint32_t> SceneLayout::written_copies() const {
  struct Choice {
    std::uint32_t placed;
    double enlargement;
  };
  std::map<std::uint32_t, Choice> of_mesh;
  for (std::uint32_t i = 0; i < placed.size(); ++i) {
    if (!placed[i].placement.is_invertible()) continue;
    const Choice here{i, enlargement(placed[i])};
    const auto [at, is_first] = of_mesh.try_emplace(placed[i].mesh, here);
    const double before = at->second.enlargement;
    if (!is_first && !(before <= max_enlargement) && here.enlargement < before) at->second = here;
  }
  std::vector<std::uint32_t> result;
  result.reserve(placed.size());
  for (const PlacedMesh& shown : placed) {
    const auto found = of_mesh.find(shown.mesh);
    result.push_back(found == of_mesh.end() ? no_index : found->second.placed);
  }
  return result;
}

}  // namespace meshbound
