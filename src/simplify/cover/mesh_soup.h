// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstdint>

#include "geometry/triangle_corners.h"
#include "numeric/no_index.h"
#include "simplify/mesh/array_mesh.h"

namespace meshbound {

/// The faces of a mesh under decimation, as `OriginalSoup` tells of the original.
struct MeshSoup {
  const ArrayMesh& mesh;

  [[nodiscard]] TriangleCorners corners(std::uint32_t face) const { return mesh.triangle(face); }
  [[nodiscard]] std::uint32_t neighbour(std::uint32_t face, std::size_t k) const {
    const Corner twin = mesh.twin(3 * face + static_cast<Corner>(k));
    return twin == no_index ? no_index : twin / 3;
  }
};

}  // namespace meshbound
