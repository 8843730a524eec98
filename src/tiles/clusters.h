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

/// A mesh in clusters of near triangles, with their boxes: tells what of it is near something else.
struct Clusters {
  /// `whole` must outlive this.
  explicit Clusters(const StoredMesh& whole);

  const StoredMesh& mesh;
  StoredLists triangles;
  std::vector<std::size_t> sizes;
  std::vector<Eigen::AlignedBox3d> boxes;
};

[[nodiscard]] Eigen::AlignedBox3d box_of(const TriangleMesh& mesh);

/// The triangles of B near a box, cluster by cluster, and a lower bound of the distance between the box and all others.
struct Near {
  std::vector<std::uint32_t> triangles;
  double rest = std::numeric_limits<double>::infinity();
};

/// All triangles with a point that is at most `reach` away from the box are among them.
[[nodiscard]] Near near_to(const Clusters& b, const Eigen::AlignedBox3d& box, double reach);

/// The triangles of A in tiles of at most `max_triangles` each, fewer where too many triangles of B are within `reach`.
[[nodiscard]] StoredLists tiles_beside(const StoredMesh& a, const Clusters& b, double reach, std::size_t max_triangles);

}  // namespace meshbound
