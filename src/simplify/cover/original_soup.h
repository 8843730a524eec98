// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "geometry/triangle_corners.h"
#include "geometry/vec3.h"
#include "meshbound/triangle_mesh.h"
#include "proof/edge_neighbours.h"

namespace meshbound {

/// The triangles of an original as a parity proof asks for them. `neighbours` are its `edge_neighbours`.
struct OriginalSoup {
  const std::vector<Vec3>& vertices;
  const std::vector<Triangle>& triangles;
  const std::vector<TriangleNeighbours>& neighbours;

  [[nodiscard]] TriangleCorners corners(std::uint32_t t) const {
    return {vertices[triangles[t][0]], vertices[triangles[t][1]], vertices[triangles[t][2]]};
  }
  [[nodiscard]] std::uint32_t neighbour(std::uint32_t t, std::size_t k) const { return neighbours[t][k]; }
};

}  // namespace meshbound
