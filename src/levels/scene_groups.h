// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <vector>

#include "meshbound/attributes.h"
#include "meshbound/triangle_mesh.h"

namespace meshbound {

/// One copy of a mesh, and the map from the frame in which the mesh is decimated to the scene.
struct SceneCopy {
  std::uint32_t placed = 0;          ///< of `SceneLayout::placed`
  std::uint32_t first_triangle = 0;  ///< of the original; the copy's triangles follow each other
  bool is_turned = false;            ///< the placement mirrors it: corners 1 and 2 of its triangles are exchanged
};

/// Triangles that are decimated together. A mesh that nodes show more than once is decimated once, in the frame of its
/// node scaled by the largest factor by which a node stretches it: what is within a tolerance there is within it in
/// every copy. What only nodes show that flatten it is not changed, as the file holds it in another frame than it is
/// seen in. All other triangles together are decimated where they stand.
struct SceneGroup {
  TriangleMesh mesh;
  bool is_kept = false;                  ///< no node shows it with an extent: its triangles stay as they are
  double scale = 1;                      ///< of the frame, if there are copies
  std::vector<SceneCopy> copies;         ///< empty: the triangles are decimated where they stand in the scene
  std::vector<std::uint32_t> vertices;   ///< by vertex of `mesh`: vertex of the original, in the first copy
  std::vector<std::uint32_t> triangles;  ///< by triangle of `mesh`: triangle of the original, in the first copy
};

/// The groups of a scene. If no mesh is shown twice or flattened, one group of everything with an empty `mesh`, which
/// stands for the original.
[[nodiscard]] std::vector<SceneGroup> scene_groups(const TriangleMesh& original, const MeshAttributes& attributes);

/// For each vertex of a group's mesh, the vertex of the original in one of its copies.
[[nodiscard]] std::vector<std::uint32_t> vertices_of_copy(const TriangleMesh& original, const SceneGroup& group,
                                                          const SceneCopy& copy);

}  // namespace meshbound
