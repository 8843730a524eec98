// SPDX-License-Identifier: MIT
#include "meshbound/line_mesh.h"

#include <string>
#include <vector>

#include "meshbound/error.h"
#include "numeric/no_index.h"

namespace meshbound {

TriangleMesh line_mesh(const TriangleMesh& mesh, std::span<const Edge> edges) {
  std::vector<std::uint32_t> index(mesh.vertices.size(), no_index);
  for (const Edge& edge : edges) {
    for (const std::uint32_t v : edge) {
      if (v >= mesh.vertices.size())
        throw InvalidInput("an edge refers to vertex " + std::to_string(v) + ", but there are only " +
                           std::to_string(mesh.vertices.size()));
      index[v] = 0;
    }
  }
  TriangleMesh lines;
  for (std::size_t v = 0; v < index.size(); ++v) {
    if (index[v] == no_index) continue;
    index[v] = static_cast<std::uint32_t>(lines.vertices.size());
    lines.vertices.push_back(mesh.vertices[v]);
  }
  lines.triangles.reserve(edges.size());
  for (const Edge& edge : edges) lines.triangles.push_back({index[edge[0]], index[edge[1]], index[edge[1]]});
  return lines;
}

}  // namespace meshbound
