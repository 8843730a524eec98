// SPDX-License-Identifier: MIT
#include "texture/chart_edges.h"

#include <cstdint>
#include <utility>
#include <vector>

#include "geometry/eigen_vec3.h"
#include "numeric/no_index.h"
#include "proof/edge_neighbours.h"

namespace meshbound {
namespace {

using CornersOfEdge = std::pair<Eigen::Vector2d, Eigen::Vector2d>;

/// The ends in the texture of the edge from corner k to the next one, with the triangle on the left.
CornersOfEdge ends_of(const ChartTriangle& t, std::size_t k) {
  const auto& uv = t.source->coordinates;
  const Eigen::Vector2d &from = uv[k], &to = uv[(k + 1) % 3];
  return t.turned ? CornersOfEdge(to, from) : CornersOfEdge(from, to);
}

}  // namespace

void link_across_edges(std::span<ChartTriangle> triangles) {
  std::vector<Vec3> corners;
  std::vector<Triangle> edges_of;
  corners.reserve(3 * triangles.size());
  edges_of.reserve(triangles.size());
  for (const ChartTriangle& t : triangles) {
    const auto first = static_cast<std::uint32_t>(corners.size());
    for (const Eigen::Vector3d& p : t.source->corners) corners.push_back(to_vec3(p));
    edges_of.push_back(t.chart == Chart::Area ? Triangle{first, first + 1, first + 2} : Triangle{first, first, first});
  }
  const std::vector<TriangleNeighbours> neighbours = edge_neighbours(corners, edges_of);
  for (std::uint32_t i = 0; i < triangles.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      if (neighbours[i][k] == no_index) continue;
      ChartTriangle& t = triangles[i];
      const ChartTriangle& other = triangles[neighbours[i][k]];
      if (t.source->material != other.source->material) continue;
      const auto [from, to] = ends_of(t, k);
      for (std::size_t j = 0; j < 3; ++j)  // an edge lies opposite to the corner after its ends
        if (neighbours[neighbours[i][k]][j] == i && ends_of(other, j) == CornersOfEdge(to, from))
          t.across[(k + 2) % 3] = &other;
    }
}

}  // namespace meshbound
