// SPDX-License-Identifier: MIT
#include "proof/edge_neighbours.h"

#include <algorithm>
#include <numeric>

#include "geometry/position_table.h"
#include "numeric/no_index.h"

namespace meshbound {
namespace {

/// The edge of a triangle from `corner` to the next, seen from its vertex of lower index.
struct HalfEdge {
  std::uint32_t high, triangle, corner;
};

template <class Use>
void for_each_half_edge(std::span<const Triangle> triangles, const std::vector<std::uint32_t>& first, const Use& use) {
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    const Triangle v{first[triangles[t][0]], first[triangles[t][1]], first[triangles[t][2]]};
    if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) continue;
    for (std::uint32_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(v[k], v[(k + 1) % 3]);
      use(low, HalfEdge{high, t, k});
    }
  }
}

/// Joins the pairs among the half-edges of one lower vertex.
void join(std::span<HalfEdge> edges, std::vector<std::array<std::uint32_t, 3>>& neighbours) {
  std::sort(edges.begin(), edges.end(), [](const HalfEdge& a, const HalfEdge& b) { return a.high < b.high; });
  for (std::size_t i = 0, j = 0; i < edges.size(); i = j) {
    for (j = i + 1; j < edges.size() && edges[j].high == edges[i].high;) ++j;
    if (j - i != 2) continue;
    neighbours[edges[i].triangle][edges[i].corner] = edges[i + 1].triangle;
    neighbours[edges[i + 1].triangle][edges[i + 1].corner] = edges[i].triangle;
  }
}

}  // namespace

std::vector<std::array<std::uint32_t, 3>> edge_neighbours(std::span<const Vec3> vertices,
                                                          std::span<const Triangle> triangles) {
  const std::vector<std::uint32_t> first = first_at_position(vertices);
  std::vector<std::size_t> end(vertices.size() + 1, 0);  // of the half-edges of each vertex, once these are put in
  for_each_half_edge(triangles, first, [&](std::uint32_t low, const HalfEdge&) { ++end[low + 1]; });
  std::partial_sum(end.begin(), end.end(), end.begin());
  std::vector<HalfEdge> edges(end.back());
  for_each_half_edge(triangles, first, [&](std::uint32_t low, const HalfEdge& edge) { edges[end[low]++] = edge; });
  std::vector<std::array<std::uint32_t, 3>> neighbours(triangles.size(), {no_index, no_index, no_index});
  std::size_t begin = 0;
  for (const std::size_t stop : std::span(end).first(vertices.size())) {
    join(std::span(edges).subspan(begin, stop - begin), neighbours);
    begin = stop;
  }
  return neighbours;
}

}  // namespace meshbound
