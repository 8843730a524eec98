// SPDX-License-Identifier: MIT
/// Where the parts of a mesh stand in the document that it was read from, without the document itself.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "meshbound/attributes.h"
#include "numeric/no_index.h"

namespace meshbound {

/// Where a node places its mesh: x -> linear x + translation.
struct NodePlacement {
  Eigen::Matrix3d linear = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();

  [[nodiscard]] bool is_identity() const { return linear.isIdentity(0) && translation.isZero(0); }
  /// A viewer turns the triangles of a mirrored mesh over, so that they still face outwards.
  [[nodiscard]] bool is_mirrored() const;
  /// False where the placement flattens the mesh, nearly or altogether, also for a scale of 0, which some files use to
  /// hide a mesh: the position in the node's frame cannot be recovered.
  [[nodiscard]] bool is_invertible() const;
  [[nodiscard]] Eigen::Vector3d to_scene(const Eigen::Vector3d& p) const;
  [[nodiscard]] Eigen::Vector3d to_node(const Eigen::Vector3d& p) const;  ///< needs `is_invertible`
  /// The placement of a mesh placed by `inner` in a frame that this one places.
  [[nodiscard]] NodePlacement operator*(const NodePlacement& inner) const;
};

/// A mesh of the document as a node of the default scene shows it.
struct PlacedMesh {
  std::uint32_t mesh = 0;
  std::uint32_t node = 0;
  NodePlacement placement;
  bool has_skin = false;  ///< joints move it; it is read in the pose of the node alone
  double reach = 0;       ///< largest absolute coordinate of its triangles in the frame of the node
};

/// A primitive of a placed mesh; `MeshAttributes::part` holds indices of `SceneLayout::parts`.
struct GltfPart {
  std::uint32_t placed = 0;  ///< of `SceneLayout::placed`
  std::uint32_t primitive = 0;
  std::uint32_t first_vertex = no_index;  ///< of the primitive, in its first triangle; `no_index`: it has no triangle
};

/// The placed meshes of a document and their parts.
struct SceneLayout {
  std::vector<PlacedMesh> placed;
  std::vector<GltfPart> parts;

  [[nodiscard]] const PlacedMesh& placed_of(std::uint32_t part) const { return placed[parts[part].placed]; }

  /// For each placed mesh, the copy of its mesh that is simplified and written: the first one whose placement is
  /// inverted with less error than floats have, else the one with the least. `no_index` where no node shows the mesh
  /// with an extent.
  [[nodiscard]] std::vector<std::uint32_t> written_copies() const;
};

/// The layout of the document that `attributes` were read from; null where there is none.
[[nodiscard]] const SceneLayout* scene_layout(const MeshAttributes& attributes);

}  // namespace meshbound
