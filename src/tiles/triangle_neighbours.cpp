// SPDX-License-Identifier: MIT
#include "tiles/triangle_neighbours.h"

#include <algorithm>
#include <functional>
#include <tuple>
#include <utility>

#include "numeric/no_index.h"

namespace meshbound {

std::vector<std::array<std::uint32_t, 3>> neighbours_of_triangles(const TriangleMesh& mesh) {
  struct Side {
    std::uint64_t edge;
    std::uint32_t triangle, corner;
  };
  std::vector<Side> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const auto [a, b] = std::minmax(mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]);
      sides.push_back({static_cast<std::uint64_t>(a) << 32 | b, t, k});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& s, const Side& other) {
    return std::tie(s.edge, s.triangle, s.corner) < std::tie(other.edge, other.triangle, other.corner);
  });
  std::vector<std::array<std::uint32_t, 3>> neighbours(mesh.triangles.size(), {no_index, no_index, no_index});
  for (std::size_t i = 1; i < sides.size(); ++i) {
    if (sides[i].edge != sides[i - 1].edge || sides[i].triangle == sides[i - 1].triangle) continue;
    neighbours[sides[i].triangle][sides[i].corner] = sides[i - 1].triangle;
    neighbours[sides[i - 1].triangle][sides[i - 1].corner] = sides[i].triangle;
  }
  for (auto& three : neighbours) std::sort(three.begin(), three.end(), std::greater<>());
  return neighbours;
}

}  // namespace meshbound
