// SPDX-License-Identifier: MIT
#include "verify/mesh_edges.h"

#include <algorithm>
#include <string>

namespace meshbound::verify {
namespace {

/// The rank of a vertex with a coordinate that is infinite or NaN. No triangle has such a vertex, so no edge has this
/// rank.
constexpr std::uint32_t no_rank = ~std::uint32_t{0};

/// By vertex: the rank of its coordinates, where 0 and -0 are equal.
std::vector<std::uint32_t> position_ranks(const TriangleMesh& mesh) {
  const auto& points = mesh.vertices;
  std::vector<std::uint32_t> order;
  for (std::uint32_t v = 0; v < points.size(); ++v)
    if (points[v].allFinite()) order.push_back(v);
  const auto is_before = [&](std::uint32_t a, std::uint32_t b) {
    return std::lexicographical_compare(points[a].begin(), points[a].end(), points[b].begin(), points[b].end());
  };
  std::sort(order.begin(), order.end(), is_before);
  std::vector<std::uint32_t> rank(points.size(), no_rank);
  std::uint32_t here = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (i > 0 && is_before(order[i - 1], order[i])) ++here;
    rank[order[i]] = here;
  }
  return rank;
}

}  // namespace

MeshEdges::MeshEdges(const TriangleMesh& mesh) : mesh_(mesh), position_(position_ranks(mesh)) {
  std::vector<Key> with_width;  // the edges of triangles with three different positions
  for (const Triangle& t : mesh.triangles) {
    const std::array<Key, 3> edges = {key(t[0], t[1]), key(t[1], t[2]), key(t[2], t[0])};
    edges_.insert(edges_.end(), edges.begin(), edges.end());
    if (std::all_of(edges.begin(), edges.end(), [](const Key& edge) { return edge[0] != edge[1]; }))
      with_width.insert(with_width.end(), edges.begin(), edges.end());
  }
  std::sort(edges_.begin(), edges_.end());
  std::sort(with_width.begin(), with_width.end());
  for (auto edge = with_width.begin(); edge != with_width.end();) {
    const auto end = std::upper_bound(edge, with_width.end(), *edge);
    if (end - edge == 1) borders_.push_back(*edge);
    edge = end;
  }
}

MeshEdges::Key MeshEdges::key(std::uint32_t a, std::uint32_t b) const {
  return {std::min(position_[a], position_[b]), std::max(position_[a], position_[b])};
}

TriangleMesh MeshEdges::lines(const EdgeList& edges, const char* name) const {
  if (edges.size() == 0) throw Rejected(std::string("it has no lines of the ") + name + " mesh");
  TriangleMesh result;
  result.vertices = mesh_.vertices;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const auto [a, b] = edges.edge(i);
    if (a >= position_.size() || b >= position_.size() || !std::binary_search(edges_.begin(), edges_.end(), key(a, b)))
      throw Rejected("line " + std::to_string(i) + " of the " + name + " mesh is no edge of a triangle");
    result.triangles.push_back({a, b, b});
  }
  return result;
}

bool MeshEdges::has_all_borders(const EdgeList& edges) const {
  std::vector<Key> listed;
  for (std::size_t i = 0; i < edges.size(); ++i) listed.push_back(key(edges.edge(i)[0], edges.edge(i)[1]));
  std::sort(listed.begin(), listed.end());
  return std::all_of(borders_.begin(), borders_.end(),
                     [&](const Key& border) { return std::binary_search(listed.begin(), listed.end(), border); });
}

}  // namespace meshbound::verify
