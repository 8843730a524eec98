// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <vector>

#include "mesh/number_lists.h"
#include "meshbound/triangle_mesh.h"

namespace meshbound {

/// A mesh with the proof that it is within a tolerance of an original, both ways: what a decimation ends with, and what
/// another one of the same original can start from.
struct ProvenMesh {
  TriangleMesh mesh;                ///< model units
  NumberLists cover;                ///< by triangle of the original: triangles of `mesh` that it is proven near
  std::vector<std::uint32_t> near;  ///< by triangle of `mesh`: a triangle of the original near it
  /// By triangle of the original: a cover outside of `mesh` is proven for it; or empty.
  std::vector<std::uint8_t> is_covered;
};

}  // namespace meshbound
