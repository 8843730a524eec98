// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "mesh/stored_lists.h"
#include "mesh/stored_mesh.h"

namespace meshbound {

/// A mesh in tiles, and each of these in clusters of near triangles with their boxes: tells what of it is near
/// something else.
struct Clusters {
  /// `whole` must outlive this. A tile has at most `max_triangles`.
  Clusters(const StoredMesh& whole, std::size_t max_triangles);

  const StoredMesh& mesh;
  StoredLists triangles;  ///< by cluster
  std::vector<std::size_t> sizes;
  std::vector<Eigen::AlignedBox3d> boxes;
  std::vector<std::size_t> first_of_tile;  ///< by tile: its first cluster; one more for the end
};

[[nodiscard]] Eigen::AlignedBox3d box_of(const TriangleMesh& mesh);

/// The triangles of B near a box, cluster by cluster, and a lower bound of the distance between the box and all others.
struct Near {
  std::vector<std::uint32_t> triangles;
  double rest = std::numeric_limits<double>::infinity();
};

/// All triangles with a point that is at most `reach` away from the box are among them.
[[nodiscard]] Near near_to(const Clusters& b, const Eigen::AlignedBox3d& box, double reach);

/// The tiles of A, which has been cut into ones of `max_triangles`, in halves where too many triangles of B are within
/// `reach`.
[[nodiscard]] StoredLists tiles_beside(const Clusters& a, const Clusters& b, double reach, std::size_t max_triangles);

}  // namespace meshbound
