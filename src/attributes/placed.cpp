// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <set>
#include <unordered_map>
#include <utility>

#include "attributes/sectors.h"
#include "mesh/gltf_document.h"
#include "mesh/gltf_primitives.h"
#include "meshbound/attributes.h"
#include "meshbound/simplify.h"

namespace meshbound {
namespace {

/// Twice the relative rounding of a float: leaves room for the rounding of doubles, and for vertices that a decimation
/// moves further from the origin than the mesh reaches.
constexpr double float_rounding = 0x1p-23;

bool moves_nothing(const MeshAttributes& attributes) {
  return attributes.document == nullptr ||
         std::all_of(attributes.document->placed.begin(), attributes.document->placed.end(),
                     [](const PlacedMesh& placed) { return placed.placement.is_identity(); });
}

}  // namespace

SimplifiedLevel placed_as_written(SimplifiedLevel level, const MeshAttributes& attributes) {
  if (moves_nothing(attributes)) return level;
  const GltfDocument& document = *attributes.document;
  std::set<Edge> lines;
  for (const Edge& edge : level.lines) lines.insert(sorted(edge));
  std::unordered_map<std::uint64_t, std::uint32_t> number_of;  // of a vertex, by placed mesh and vertex
  number_of.reserve(level.mesh.vertices.size());
  const TriangleMesh from = std::exchange(level.mesh, {});
  const std::vector<std::uint32_t> source_vertex = std::exchange(level.source_vertex, {});
  level.lines.clear();
  for (std::size_t t = 0; t < from.triangles.size(); ++t) {
    const GltfPart part = document.parts[attributes.part[t]];
    const NodePlacement& placement = document.placed[part.placed].placement;
    Triangle& corners = level.mesh.triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = from.triangles[t][k];
      const auto [at, is_new] = number_of.try_emplace(std::uint64_t{part.placed} << 32 | v,
                                                      static_cast<std::uint32_t>(level.mesh.vertices.size()));
      corners[k] = at->second;
      if (!is_new) continue;
      const Eigen::Vector3d& p = from.vertices[v];
      level.mesh.vertices.push_back(placement.is_invertible() ? placement.to_scene(written_position(placement, p)) : p);
      level.source_vertex.push_back(source_vertex[v]);
    }
    for (std::size_t k = 0; k < 3; ++k) {
      if (lines.erase(sorted({from.triangles[t][k], from.triangles[t][(k + 1) % 3]})) > 0)
        level.lines.push_back({corners[k], corners[(k + 1) % 3]});
    }
  }
  return level;
}

double placement_rounding(const TriangleMesh& mesh, const MeshAttributes& attributes) {
  if (moves_nothing(attributes)) return 0;
  double max = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const NodePlacement& placement = attributes.document->placed_of(attributes.part[t]).placement;
    if (!placement.is_invertible()) continue;
    for (const std::uint32_t v : mesh.triangles[t])
      max = std::max(max, placement.linear.norm() * placement.to_node(mesh.vertices[v]).norm());
  }
  return float_rounding * max;
}

}  // namespace meshbound
