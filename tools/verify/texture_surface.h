// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "meshbound/attributes.h"
#include "meshbound/triangle_mesh.h"

namespace meshbound::verify {

/// A mesh as its texture sees it: the triangles that have texture coordinates at all corners.
struct TextureSurface {
  struct Triangle {
    std::uint32_t index = 0;  ///< in the mesh
    /// Equal only for triangles whose coordinates can be equal: the number of the material's name, or 0 for all.
    std::uint32_t material = 0;
    std::array<Eigen::Vector3d, 3> corners;
    std::array<Eigen::Vector2d, 3> coordinates;
    double area = 0;  ///< rounded, in a unit that all triangles of the mesh share: for ratios only
  };
  std::vector<Triangle> triangles;     ///< in the order of the mesh
  std::vector<std::int64_t> of_index;  ///< by triangle of the mesh: its place in `triangles`, or -1
  double area = 0;                     ///< sum of the areas of all triangles of the mesh
  double bare_area = 0;                ///< sum of the areas of the triangles without coordinates
};

/// A mesh and what its file says of its texture; both must outlive the use.
struct TexturedFile {
  const TriangleMesh* mesh = nullptr;
  const MeshAttributes* attributes = nullptr;
};

/// The original and the simplified mesh, the coordinates of both as the file of the original would hold them, and then
/// as that of the simplified mesh would. Materials are told apart, by their names, where both files have them. Throws
/// `Rejected` where a mesh has no texture coordinates, or one that is not finite. O(n).
[[nodiscard]] std::array<TextureSurface, 2> texture_surfaces(const TexturedFile& original,
                                                             const TexturedFile& simplified);

/// Multiplies the texture coordinates of both by one power of two that makes them about 1, where nothing is rounded:
/// which of them are equal does not change. O(n).
void scale_coordinates(std::array<TextureSurface, 2>& surfaces);

/// The checksum of the indices and texture coordinates of all triangles that have them. O(n).
[[nodiscard]] std::uint64_t checksum_of(const TextureSurface& surface);

}  // namespace meshbound::verify
