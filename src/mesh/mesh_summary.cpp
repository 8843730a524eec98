// SPDX-License-Identifier: MIT
#include "meshbound/mesh_summary.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "geometry/safe_length.h"
#include "mesh/mesh_arrays.h"
#include "mesh/stored_mesh.h"
#include "numeric/disjoint_sets.h"

namespace meshbound {
namespace {

/// Calls use(corners) for all triangles.
template <class Use>
void for_each_triangle(const MeshView& mesh, const Use& use) {
  for (std::size_t i = 0; i < mesh.triangle_count(); ++i) use(mesh.triangle(i));
}
template <class Use>
void for_each_triangle(const StoredMesh& mesh, const Use& use) {
  mesh.for_each_triangle([&](std::uint32_t, const Triangle& corners) { use(corners); });
}

template <class Mesh>
std::size_t count_components(const Mesh& mesh) {
  DisjointSets sets(mesh.vertex_count());
  for_each_triangle(mesh, [&](const Triangle& t) {
    sets.unite(t[0], t[1]);
    sets.unite(t[1], t[2]);
  });
  std::vector<bool> seen(mesh.vertex_count(), false);
  std::size_t components = 0;
  for_each_triangle(mesh, [&](const Triangle& t) {
    const std::uint32_t root = sets.find(t[0]);
    if (!seen[root]) ++components;
    seen[root] = true;
  });
  return components;
}

/// Vertices [begin, end).
struct VertexRange {
  std::size_t begin, end;
};

/// The edges of a mesh whose smaller vertex is in a range, grouped by that; one entry for each triangle at an edge.
struct EdgeTable {
  std::vector<std::size_t> first;     // group of the k-th vertex of the range: [first[k], first[k + 1])
  std::vector<std::uint32_t> larger;  // the other vertex
};

/// Calls visit(smaller vertex, larger vertex) for each edge of each triangle.
template <class Mesh, class Visit>
void for_each_edge(const Mesh& mesh, const Visit& visit) {
  for_each_triangle(mesh, [&](const Triangle& t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k];
      const std::uint32_t b = t[(k + 1) % 3];
      visit(a < b ? a : b, a < b ? b : a);
    }
  });
}

template <class Mesh>
EdgeTable group_edges(const Mesh& mesh, const VertexRange& range) {
  EdgeTable table;
  table.first.assign(range.end - range.begin + 2, 0);
  for_each_edge(mesh, [&](std::uint32_t a, std::uint32_t) {
    if (a >= range.begin && a < range.end) ++table.first[a - range.begin + 2];
  });
  std::partial_sum(table.first.begin(), table.first.end(), table.first.begin());
  table.larger.resize(table.first.back());
  // Filling advances first[k + 1] from the start of the group of vertex k to its end, which is where it has to be
  // afterwards.
  for_each_edge(mesh, [&](std::uint32_t a, std::uint32_t b) {
    if (a >= range.begin && a < range.end) table.larger[table.first[a - range.begin + 1]++] = b;
  });
  return table;
}

/// Ranges of vertices that have at most so many edges to larger ones, or few vertices.
template <class Mesh>
std::vector<VertexRange> ranges_of(const Mesh& mesh, std::size_t max_edges) {
  constexpr std::size_t vertices_of_block = 4096;
  std::vector<std::size_t> edges(mesh.vertex_count() / vertices_of_block + 1, 0);
  for_each_edge(mesh, [&](std::uint32_t a, std::uint32_t) { ++edges[a / vertices_of_block]; });
  std::vector<VertexRange> ranges;
  std::size_t in_range = 0;
  for (std::size_t k = 0; k < edges.size(); ++k) {
    const std::size_t begin = k * vertices_of_block;
    if (ranges.empty() || in_range + edges[k] > max_edges) {
      ranges.push_back({begin, begin});
      in_range = 0;
    }
    ranges.back().end = std::min(begin + vertices_of_block, mesh.vertex_count());
    in_range += edges[k];
  }
  return ranges;
}

template <class Mesh>
bool repeats_vertex(const Mesh& mesh) {
  bool repeats = false;
  for_each_triangle(mesh,
                    [&](const Triangle& t) { repeats = repeats || t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
  return repeats;
}

/// `max_edges`: that are looked at in one go over the triangles.
template <class Mesh>
bool is_closed(const Mesh& mesh, std::size_t max_edges) {
  if (mesh.triangle_count() == 0 || repeats_vertex(mesh)) return false;
  // Triangles at the edge from the current vertex to each other one; 3 for more.
  std::vector<std::uint8_t> triangles_at(mesh.vertex_count(), 0);
  for (const VertexRange& range : ranges_of(mesh, max_edges)) {
    const EdgeTable edges = group_edges(mesh, range);
    for (std::size_t k = 0; k < range.end - range.begin; ++k) {
      const std::size_t from = edges.first[k];
      const std::size_t to = edges.first[k + 1];
      for (std::size_t i = from; i < to; ++i) {
        std::uint8_t& count = triangles_at[edges.larger[i]];
        count = static_cast<std::uint8_t>(std::min(count + 1, 3));
      }
      for (std::size_t i = from; i < to; ++i)
        if (triangles_at[edges.larger[i]] != 2) return false;
      for (std::size_t i = from; i < to; ++i) triangles_at[edges.larger[i]] = 0;
    }
  }
  return true;
}

}  // namespace

MeshSummary summarise(const MeshView& mesh) {
  MeshSummary summary;
  summary.vertices = mesh.vertex_count();
  summary.faces = mesh.triangle_count();
  summary.components = count_components(mesh);
  summary.closed = is_closed(mesh, std::numeric_limits<std::size_t>::max());
  summary.bbox_diagonal = bounding_box_diagonal(mesh);
  return summary;
}

MeshSummary summarise(const StoredMesh& mesh, std::size_t max_edges) {
  return {mesh.vertex_count(), mesh.triangle_count(), count_components(mesh),
          is_closed(mesh, std::max(max_edges, mesh.triangle_count() / 4)), diagonal_of(used_bounding_box(mesh))};
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
  return safe_length(box.sizes());
}

double bounding_box_diagonal(const MeshView& mesh) { return diagonal_of(used_bounding_box(mesh)); }

}  // namespace meshbound
