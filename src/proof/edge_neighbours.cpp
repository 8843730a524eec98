// SPDX-License-Identifier: MIT
#include "proof/edge_neighbours.h"

#include <algorithm>
#include <numeric>

#include "bvh/bvh_data.h"
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
void join(std::span<HalfEdge> edges, std::vector<TriangleNeighbours>& neighbours) {
  std::sort(edges.begin(), edges.end(), [](const HalfEdge& a, const HalfEdge& b) { return a.high < b.high; });
  for (std::size_t i = 0, j = 0; i < edges.size(); i = j) {
    for (j = i + 1; j < edges.size() && edges[j].high == edges[i].high;) ++j;
    if (j - i != 2) continue;
    neighbours[edges[i].triangle][edges[i].corner] = edges[i + 1].triangle;
    neighbours[edges[i + 1].triangle][edges[i + 1].corner] = edges[i].triangle;
  }
}

/// Checks what a tree says of the neighbours of its triangles.
class CheckedNeighbours {
 public:
  CheckedNeighbours(const Bvh::Data& tree, std::span<const Vec3> vertices, std::span<const Triangle> triangles)
      : tree_(tree), vertices_(vertices), triangles_(triangles) {}

  /// The neighbours of the triangle in a slot, in the order of its corners in the mesh.
  [[nodiscard]] TriangleNeighbours operator()(std::uint32_t slot) const {
    TriangleNeighbours neighbours{no_index, no_index, no_index};
    const Triangle& t = triangle(slot);
    if (!has_three_positions(t)) return neighbours;
    const std::uint32_t turn = first_corner(slot);
    for (std::uint32_t e = 0; e < 3; ++e) {
      const std::uint32_t k = (turn + e) % 3, across = tree_.neighbours[slot][e].slot;
      if (across != no_slot && is_partner(across, t[k], t[(k + 1) % 3], slot))
        neighbours[k] = tree_.triangle_of_slot[across];
    }
    return neighbours;
  }

 private:
  [[nodiscard]] const Triangle& triangle(std::uint32_t slot) const { return triangles_[tree_.triangle_of_slot[slot]]; }
  [[nodiscard]] bool are_one(std::uint32_t u, std::uint32_t v) const {
    return u == v || same_position(vertices_[u], vertices_[v]);
  }
  [[nodiscard]] bool has_three_positions(const Triangle& t) const {
    return !are_one(t[0], t[1]) && !are_one(t[1], t[2]) && !are_one(t[2], t[0]);
  }
  /// The corner in the mesh of the one that the tree has first.
  [[nodiscard]] std::uint32_t first_corner(std::uint32_t slot) const {
    const Triangle& t = triangle(slot);
    const std::uint32_t first = tree_.source_vertex[tree_.corners[slot][0]];
    return first == t[0] ? 0 : first == t[1] ? 1 : 2;
  }
  /// Whether the edge from u to v of the triangle in slot `from` is the partner of an edge of the one in `slot`.
  [[nodiscard]] bool is_partner(std::uint32_t slot, std::uint32_t u, std::uint32_t v, std::uint32_t from) const {
    const Triangle& t = triangle(slot);
    if (slot == from || !has_three_positions(t)) return false;
    const std::uint32_t turn = first_corner(slot);
    for (std::uint32_t e = 0; e < 3; ++e) {
      const std::uint32_t p = t[(turn + e) % 3], q = t[(turn + e + 1) % 3];
      if ((are_one(p, u) && are_one(q, v)) || (are_one(p, v) && are_one(q, u)))
        return tree_.neighbours[slot][e].slot == from;
    }
    return false;
  }

  const Bvh::Data& tree_;
  std::span<const Vec3> vertices_;
  std::span<const Triangle> triangles_;
};

}  // namespace

std::vector<TriangleNeighbours> edge_neighbours(const Bvh& tree, std::span<const Vec3> vertices,
                                                std::span<const Triangle> triangles) {
  const CheckedNeighbours neighbours_of(tree.data(), vertices, triangles);
  std::vector<TriangleNeighbours> neighbours(triangles.size());
  for (std::uint32_t slot = 0; slot < triangles.size(); ++slot)
    neighbours[tree.data().triangle_of_slot[slot]] = neighbours_of(slot);
  return neighbours;
}

std::vector<TriangleNeighbours> edge_neighbours(std::span<const Vec3> vertices, std::span<const Triangle> triangles) {
  const std::vector<std::uint32_t> first = first_at_position(vertices);
  std::vector<std::size_t> end(vertices.size() + 1, 0);  // of the half-edges of each vertex, once these are put in
  for_each_half_edge(triangles, first, [&](std::uint32_t low, const HalfEdge&) { ++end[low + 1]; });
  std::partial_sum(end.begin(), end.end(), end.begin());
  std::vector<HalfEdge> edges(end.back());
  for_each_half_edge(triangles, first, [&](std::uint32_t low, const HalfEdge& edge) { edges[end[low]++] = edge; });
  std::vector<TriangleNeighbours> neighbours(triangles.size(), {no_index, no_index, no_index});
  std::size_t begin = 0;
  for (const std::size_t stop : std::span(end).first(vertices.size())) {
    join(std::span(edges).subspan(begin, stop - begin), neighbours);
    begin = stop;
  }
  return neighbours;
}

}  // namespace meshbound
