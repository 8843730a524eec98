// SPDX-License-Identifier: MIT
/// Small meshes of the kinds that a search over neighbouring triangles finds hard: unwelded soups, hubs, seams, layers,
/// ties and needles. A random generator or the bytes of a fuzzer choose the rest.
#pragma once
#include <Eigen/Core>

#include "meshbound/triangle_mesh.h"

namespace meshbound::reference {

/// Where the free parameters of a mesh come from.
class Choices {
 public:
  Choices() = default;
  Choices(const Choices&) = delete;
  Choices& operator=(const Choices&) = delete;
  virtual ~Choices() = default;
  virtual Eigen::Vector3d point() = 0;
  /// 0 to n - 1. `n` from 1 to 256.
  virtual unsigned below(unsigned n) = 0;
};

enum class HardShape {
  Unwelded,     ///< every triangle has vertices of its own
  Hub,          ///< a fan, open or closed, a star around one vertex, or triangles around one edge
  Seams,        ///< some corners have a vertex of their own at equal coordinates, zeros of the other sign included
  Layers,       ///< coplanar triangles that overlap, in up to three parallel planes
  Sheets,       ///< copies of one patch at equal distances, so that points between are equally near to two of them
  NeedleStack,  ///< long thin triangles on top of one another
};
inline constexpr unsigned hard_shapes = 6;

/// About `triangles` of them, at least one and never more than `triangles` + 2.
[[nodiscard]] TriangleMesh hard_mesh(HardShape shape, Choices& choices, unsigned triangles);

/// A copy of a mesh in which each triangle has vertices of its own.
[[nodiscard]] TriangleMesh unwelded(const TriangleMesh& mesh);

/// The mesh with its triangles as they are, of which some corners have a vertex of their own. A coordinate of 0 is -0
/// there.
[[nodiscard]] TriangleMesh with_seams(const TriangleMesh& mesh, Choices& choices);

}  // namespace meshbound::reference
