// SPDX-License-Identifier: MIT
#include "simplify/mesh/indexed_manifold.h"

#include <algorithm>
#include <string>
#include <tuple>

#include "mesh/mesh_arrays.h"
#include "meshbound/error.h"
#include "numeric/no_index.h"

namespace meshbound {
namespace {

struct DirectedEdge {
  std::uint32_t from, to;
  Corner corner;
  [[nodiscard]] bool before(const DirectedEdge& o) const { return std::tie(from, to) < std::tie(o.from, o.to); }
};

[[noreturn]] void refuse(const std::string& reason) {
  throw InvalidInput(reason + ": the mesh is no oriented 2-manifold; split it first");
}

std::vector<DirectedEdge> sorted_edges(const TriangleMesh& mesh) {
  std::vector<DirectedEdge> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& v = mesh.triangles[t];
    for (std::size_t k = 0; k < 3; ++k) {
      if (v[k] == v[(k + 1) % 3]) refuse("triangle " + std::to_string(t) + " has two equal corners");
      edges.push_back({v[k], v[(k + 1) % 3], static_cast<Corner>(3 * t + k)});
    }
  }
  const auto before = [](const DirectedEdge& a, const DirectedEdge& b) { return a.before(b); };
  std::sort(edges.begin(), edges.end(), before);
  const auto repeated = std::adjacent_find(
      edges.begin(), edges.end(), [](const auto& a, const auto& b) { return a.from == b.from && a.to == b.to; });
  if (repeated != edges.end())
    refuse("two triangles run along the edge from vertex " + std::to_string(repeated->from) + " to " +
           std::to_string(repeated->to));
  return edges;
}

/// A vertex with several fans of triangles would be found from one of them only.
void check_fans(const ArrayMesh& mesh) {
  std::vector<std::uint32_t> corners(mesh.vertex_count(), 0);
  for (Corner c = 0; c < 3 * mesh.face_count(); ++c) ++corners[mesh.vertex(c)];
  for (std::uint32_t v = 0; v < corners.size(); ++v) {
    if (corners[v] == 0) continue;
    std::uint32_t found = 0;
    mesh.for_each_corner(v, [&](Corner) { return ++found <= corners[v]; });
    if (found != corners[v]) refuse("vertex " + std::to_string(v) + " joins several fans of triangles");
  }
}

}  // namespace

ArrayMesh indexed_manifold(const TriangleMesh& mesh) {
  const std::vector<DirectedEdge> edges = sorted_edges(mesh);
  std::vector<std::array<std::uint32_t, 3>> twins(mesh.triangles.size());
  for (const DirectedEdge& edge : edges) {
    const DirectedEdge opposite{edge.to, edge.from, 0};
    const auto at = std::lower_bound(edges.begin(), edges.end(), opposite,
                                     [](const DirectedEdge& a, const DirectedEdge& b) { return a.before(b); });
    const bool found = at != edges.end() && at->from == edge.to && at->to == edge.from;
    twins[edge.corner / 3][edge.corner % 3] = found ? at->corner : no_index;
  }
  ArrayMesh result(positions_of(mesh), {mesh.triangles.begin(), mesh.triangles.end()}, twins);
  check_fans(result);
  return result;
}

}  // namespace meshbound
