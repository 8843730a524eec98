// SPDX-License-Identifier: MIT
#include "proof/edge_neighbours.h"

#include <algorithm>
#include <utility>

#include "bvh/bvh_data.h"
#include "geometry/position_table.h"
#include "numeric/buckets.h"
#include "numeric/no_index.h"
#include "numeric/tasks.h"

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
      : tree_(tree), vertices_(vertices), triangles_(triangles), first_corner_(triangles.size()) {}

  /// Looks at the corners of the triangle in a slot. All must have been looked at before neighbours are asked for.
  void look_at(std::uint32_t slot) {
    const Triangle& t = triangle(slot);
    const std::uint32_t first = tree_.source_vertex[tree_.corners[slot][0]];
    const bool is_degenerate = are_one(t[0], t[1]) || are_one(t[1], t[2]) || are_one(t[2], t[0]);
    first_corner_[slot] = is_degenerate ? degenerate : first == t[0] ? 0 : first == t[1] ? 1 : 2;
  }

  /// The neighbours of the triangle in a slot, in the order of its corners in the mesh.
  [[nodiscard]] TriangleNeighbours operator()(std::uint32_t slot) const {
    TriangleNeighbours neighbours{no_index, no_index, no_index};
    if (first_corner_[slot] == degenerate) return neighbours;
    const Triangle& t = triangle(slot);
    for (std::uint32_t e = 0; e < 3; ++e) {
      const std::uint32_t k = corner(slot, e), across = tree_.neighbours[slot][e].slot;
      if (across != no_slot && is_partner(across, t[k], t[after(k)], slot))
        neighbours[k] = tree_.triangle_of_slot[across];
    }
    return neighbours;
  }

 private:
  static constexpr std::uint8_t degenerate = 3;  ///< two corners have one position

  [[nodiscard]] const Triangle& triangle(std::uint32_t slot) const { return triangles_[tree_.triangle_of_slot[slot]]; }
  [[nodiscard]] bool are_one(std::uint32_t u, std::uint32_t v) const {
    return u == v || same_position(vertices_[u], vertices_[v]);
  }
  static std::uint32_t after(std::uint32_t corner) { return corner == 2 ? 0 : corner + 1; }
  /// The number in the mesh of a corner of the tree.
  [[nodiscard]] std::uint32_t corner(std::uint32_t slot, std::uint32_t of_tree) const {
    const std::uint32_t k = first_corner_[slot] + of_tree;
    return k < 3 ? k : k - 3;
  }
  /// Whether the edge from u to v of the triangle in slot `from` is the partner of an edge of the one in `slot`.
  [[nodiscard]] bool is_partner(std::uint32_t slot, std::uint32_t u, std::uint32_t v, std::uint32_t from) const {
    if (slot == from || first_corner_[slot] == degenerate) return false;
    const Triangle& t = triangle(slot);
    for (std::uint32_t e = 0; e < 3; ++e) {
      if (tree_.neighbours[slot][e].slot != from) continue;
      const std::uint32_t k = corner(slot, e), p = t[k], q = t[after(k)];
      if ((are_one(p, v) && are_one(q, u)) || (are_one(p, u) && are_one(q, v))) return true;
    }
    return false;
  }

  const Bvh::Data& tree_;
  std::span<const Vec3> vertices_;
  std::span<const Triangle> triangles_;
  std::vector<std::uint8_t> first_corner_;  ///< by slot: the one in the mesh that the tree has first; or `degenerate`
};

constexpr std::size_t grain = 4096;  ///< slots that a thread takes at once

}  // namespace

bool lies_between_two(const TriangleNeighbours& neighbours) {
  std::uint32_t across = no_index;
  for (const std::uint32_t other : neighbours) {
    if (other == no_index) continue;
    if (across != no_index && across != other) return true;
    across = other;
  }
  return false;
}

std::vector<TriangleNeighbours> edge_neighbours(const Bvh& tree, std::span<const Vec3> vertices,
                                                std::span<const Triangle> triangles, int threads) {
  CheckedNeighbours neighbours_of(tree.data(), vertices, triangles);
  std::vector<TriangleNeighbours> neighbours(triangles.size());
  const auto for_each_slot = [&](const auto& use) {
    for_each_range(triangles.size(), grain, [&](std::size_t begin, std::size_t end) {
      for (auto slot = static_cast<std::uint32_t>(begin); slot < end; ++slot) use(slot);
    });
  };
  with_team(threads, [&] {
    for_each_slot([&](std::uint32_t slot) { neighbours_of.look_at(slot); });
    for_each_slot([&](std::uint32_t slot) {
      neighbours[tree.data().triangle_of_slot[slot]] = std::as_const(neighbours_of)(slot);
    });
  });
  return neighbours;
}

std::vector<TriangleNeighbours> edge_neighbours(std::span<const Vec3> vertices, std::span<const Triangle> triangles) {
  const std::vector<std::uint32_t> first = first_at_position(vertices);
  Buckets<HalfEdge> by_lower_vertex(vertices.size(),
                                    [&](const auto& add) { for_each_half_edge(triangles, first, add); });
  std::vector<TriangleNeighbours> neighbours(triangles.size(), {no_index, no_index, no_index});
  for (std::size_t v = 0; v < by_lower_vertex.size(); ++v) join(by_lower_vertex[v], neighbours);
  return neighbours;
}

}  // namespace meshbound
