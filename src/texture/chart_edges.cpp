// SPDX-License-Identifier: MIT
#include "texture/chart_edges.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "numeric/no_index.h"
#include "proof/edge_neighbours.h"

namespace meshbound {
namespace {

/// Whether a triangle has an edge from one coordinate to another, in counter-clockwise order of its corners.
bool runs_along(const ChartTriangle& t, const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  const auto& uv = t.source->coordinates;
  for (std::size_t k = 0; k < 3; ++k) {
    const Eigen::Vector2d &p = uv[k], &q = uv[(k + 1) % 3];
    if (t.turned ? p == to && q == from : p == from && q == to) return true;
  }
  return false;
}

}  // namespace

/// Points of a space with the material as third coordinate stand for the texture coordinates.
void link_across_edges(std::span<ChartTriangle> triangles) {
  std::vector<Vec3> corners;
  std::vector<Triangle> edges_of;
  corners.reserve(3 * triangles.size());
  edges_of.reserve(triangles.size());
  for (const ChartTriangle& t : triangles) {
    const auto first = static_cast<std::uint32_t>(corners.size());
    for (const Eigen::Vector2d& uv : t.source->coordinates)
      corners.push_back({uv.x(), uv.y(), static_cast<double>(t.source->material)});
    edges_of.push_back(t.chart == Chart::Area ? Triangle{first, first + 1, first + 2} : Triangle{first, first, first});
  }
  const std::vector<TriangleNeighbours> neighbours = edge_neighbours(corners, edges_of);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    ChartTriangle& t = triangles[i];
    const auto& uv = t.source->coordinates;
    for (std::size_t k = 0; k < 3; ++k) {  // the edge from corner k to the next lies opposite to the last
      if (neighbours[i][k] == no_index) continue;
      const ChartTriangle& other = triangles[neighbours[i][k]];
      const Eigen::Vector2d &from = uv[k], &to = uv[(k + 1) % 3];
      const bool is_on_other_side = t.turned ? runs_along(other, from, to) : runs_along(other, to, from);
      if (is_on_other_side) t.across[(k + 2) % 3] = &other;
    }
  }
}

}  // namespace meshbound
