// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace meshbound {

/// The corners of a triangle as indices of vertices.
using Triangle = std::array<std::uint32_t, 3>;

/// An indexed triangle soup. Nothing is assumed of it: it may be open, non-manifold, self-intersecting, of many
/// components, with degenerate or duplicate triangles and with vertices that no triangle uses.
struct TriangleMesh {
  std::vector<Eigen::Vector3d> vertices;  ///< model units
  std::vector<Triangle> triangles;        ///< indices into `vertices`
};

}  // namespace meshbound
