// SPDX-License-Identifier: MIT
#include "meshbound/mesh_summary.h"

#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "mesh/mesh_arrays.h"
#include "numeric/disjoint_sets.h"

namespace meshbound {
namespace {

std::size_t count_components(const MeshView& mesh) {
  DisjointSets sets(mesh.vertex_count());
  for (std::size_t i = 0; i < mesh.triangle_count(); ++i) {
    const Triangle t = mesh.triangle(i);
    sets.unite(t[0], t[1]);
    sets.unite(t[1], t[2]);
  }
  std::vector<bool> seen(mesh.vertex_count(), false);
  std::size_t components = 0;
  for (std::size_t i = 0; i < mesh.triangle_count(); ++i) {
    const std::uint32_t root = sets.find(mesh.triangle(i)[0]);
    if (!seen[root]) ++components;
    seen[root] = true;
  }
  return components;
}

/// The edges of a mesh, grouped by the smaller of their two vertices; one entry for each triangle at an edge.
struct EdgeTable {
  std::vector<std::size_t> first;     // group of vertex v: [first[v], first[v + 1])
  std::vector<std::uint32_t> larger;  // the other vertex
};

template <class Visit>
void for_each_edge(const MeshView& mesh, const Visit& visit) {
  for (std::size_t i = 0; i < mesh.triangle_count(); ++i) {
    const Triangle t = mesh.triangle(i);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k];
      const std::uint32_t b = t[(k + 1) % 3];
      visit(a < b ? a : b, a < b ? b : a);
    }
  }
}

EdgeTable group_edges(const MeshView& mesh) {
  EdgeTable table;
  table.first.assign(mesh.vertex_count() + 2, 0);
  for_each_edge(mesh, [&](std::uint32_t a, std::uint32_t) { ++table.first[a + 2]; });
  std::partial_sum(table.first.begin(), table.first.end(), table.first.begin());
  table.larger.resize(3 * mesh.triangle_count());
  // Filling advances first[a + 1] from the start of the group of `a` to its end, which is where it has to be
  // afterwards.
  for_each_edge(mesh, [&](std::uint32_t a, std::uint32_t b) { table.larger[table.first[a + 1]++] = b; });
  return table;
}

bool repeats_vertex(const MeshView& mesh) {
  for (std::size_t i = 0; i < mesh.triangle_count(); ++i) {
    const Triangle t = mesh.triangle(i);
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) return true;
  }
  return false;
}

bool is_closed(const MeshView& mesh) {
  if (mesh.triangle_count() == 0 || repeats_vertex(mesh)) return false;
  const EdgeTable edges = group_edges(mesh);
  std::vector<std::uint32_t> triangles_at(mesh.vertex_count(), 0);  // edges from the current vertex to each other one
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    const std::size_t from = edges.first[v];
    const std::size_t to = edges.first[v + 1];
    for (std::size_t i = from; i < to; ++i) ++triangles_at[edges.larger[i]];
    for (std::size_t i = from; i < to; ++i)
      if (triangles_at[edges.larger[i]] != 2) return false;
    for (std::size_t i = from; i < to; ++i) triangles_at[edges.larger[i]] = 0;
  }
  return true;
}

}  // namespace

MeshSummary summarise(const MeshView& mesh) {
  MeshSummary summary;
  summary.vertices = mesh.vertex_count();
  summary.faces = mesh.triangle_count();
  summary.components = count_components(mesh);
  summary.closed = is_closed(mesh);
  summary.bbox_diagonal = bounding_box_diagonal(mesh);
  return summary;
}

Eigen::AlignedBox3d used_bounding_box(const MeshView& mesh) {
  // Each vertex once, not once for each corner.
  const std::vector<std::uint8_t> used = used_vertices(mesh);
  Eigen::AlignedBox3d box;
  for (std::size_t v = 0; v < used.size(); ++v)
    if (used[v] != 0) box.extend(mesh.vertex(v));
  return box;
}

double diagonal_of(const Eigen::AlignedBox3d& box) {
  if (box.isEmpty()) return 0;
  const Eigen::Vector3d size = box.sizes();
  return std::hypot(size.x(), size.y(), size.z());
}

double bounding_box_diagonal(const MeshView& mesh) { return diagonal_of(used_bounding_box(mesh)); }

}  // namespace meshbound
