// SPDX-License-Identifier: MIT
#include "mesh/split_vertices.h"

#include <algorithm>
#include <cmath>

#include "numeric/no_index.h"

namespace meshbound {

SplitVertices split_vertices(const TriangleMesh& mesh, const std::vector<std::uint32_t>& triangles,
                             const std::vector<const std::vector<Triangle>*>& indices) {
  SplitVertices result;
  std::vector<std::uint32_t> last_made(mesh.vertices.size(), no_index);  // by source vertex: the last one made from it
  std::vector<std::uint32_t> made_before;  // by vertex of the result: the one made before it from the same source
  const auto is_alike = [&](std::uint32_t a, std::uint32_t b) {
    return std::all_of(indices.begin(), indices.end(), [&](const std::vector<Triangle>* index) {
      return index->empty() || (*index)[a / 3][a % 3] == (*index)[b / 3][b % 3];
    });
  };
  for (const std::uint32_t t : triangles) {
    Triangle& corners = result.triangles.emplace_back();
    for (std::uint32_t k = 0; k < 3; ++k) {
      std::uint32_t& last = last_made[mesh.triangles[t][k]];
      std::uint32_t vertex = last;
      while (vertex != no_index && !is_alike(result.corners[vertex], 3 * t + k)) vertex = made_before[vertex];
      if (vertex == no_index) {
        vertex = static_cast<std::uint32_t>(result.corners.size());
        result.corners.push_back(3 * t + k);
        made_before.push_back(last);
        last = vertex;
      }
      corners[k] = vertex;
    }
  }
  return result;
}

const NamedAttribute* colours_of(const MeshAttributes& attributes) {
  for (const NamedAttribute& named : attributes.named)
    if (named.name == "COLOR_0" && named.width >= 3) return &named;
  return nullptr;
}

bool holds_bytes(const NamedAttribute& colours) {
  constexpr double rounding = 1e-9;
  return std::all_of(colours.values.begin(), colours.values.end(), [](double value) {
    return value >= 0 && value <= 1 && std::abs(value * 255 - std::round(value * 255)) < rounding;
  });
}

}  // namespace meshbound
