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
#include "numeric/no_index.h"

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

/// The most roundings after which a written position must stay as it is. One is enough unless doubles in the scene are
/// about as coarse as floats in the frame of the node, as far from the origin; few are then.
constexpr int max_roundings = 64;

/// A position of the scene in the frame of a node as the file will hold it, and the same for what it becomes in the
/// scene, so that it is written as it was foreseen.
Eigen::Vector3d lasting_position(const NodePlacement& placement, const Eigen::Vector3d& p) {
  Eigen::Vector3d local = written_position(placement, p);
  for (int i = 0; i < max_roundings; ++i) {
    const Eigen::Vector3d again = written_position(placement, placement.to_scene(local));
    if (again == local) break;
    local = again;
  }
  return local;
}

/// The triangles of the copies of meshes in a level, and those of the written copy to which they correspond: copies
/// have their triangles in one order.
class WrittenTriangles {
 public:
  WrittenTriangles(const SceneLayout& layout, const std::vector<std::uint32_t>& part_of_triangle)
      : written_(layout.written_copies()), triangles_(layout.placed.size()) {
    for (std::uint32_t t = 0; t < part_of_triangle.size(); ++t) {
      std::vector<std::uint32_t>& copy = triangles_[layout.parts[part_of_triangle[t]].placed];
      number_.push_back(static_cast<std::uint32_t>(copy.size()));
      copy.push_back(t);
    }
  }

  /// The written copy of the mesh of a placed one; itself where the copies in the level are not alike. `no_index` where
  /// the mesh is not written.
  [[nodiscard]] std::uint32_t copy_of(std::uint32_t placed) const {
    const std::uint32_t written = written_[placed];
    if (written == no_index || triangles_[written].size() == triangles_[placed].size()) return written;
    return placed;
  }
  /// The triangle of `copy` that triangle `t` of another copy repeats.
  [[nodiscard]] std::uint32_t triangle_of(std::uint32_t copy, std::uint32_t t) const {
    return triangles_[copy][number_[t]];
  }

 private:
  std::vector<std::uint32_t> written_;                 ///< by placed mesh
  std::vector<std::vector<std::uint32_t>> triangles_;  ///< by placed mesh
  std::vector<std::uint32_t> number_;                  ///< by triangle: among those of its placed mesh
};

}  // namespace

SimplifiedLevel placed_as_written(SimplifiedLevel level, const MeshAttributes& attributes) {
  if (moves_nothing(attributes)) return level;
  const GltfDocument& document = *attributes.document;
  const WrittenTriangles written(document, attributes.part);
  std::set<Edge> lines;
  for (const Edge& edge : level.lines) lines.insert(sorted(edge));
  std::unordered_map<std::uint64_t, std::uint32_t> number_of;  // of a vertex, by placed mesh and written vertex
  number_of.reserve(level.mesh.vertices.size());
  const TriangleMesh from = std::exchange(level.mesh, {});
  const std::vector<std::uint32_t> source_vertex = std::exchange(level.source_vertex, {});
  level.lines.clear();
  const auto key_of = [](std::uint32_t placed, std::uint32_t vertex) { return std::uint64_t{placed} << 32 | vertex; };
  for (std::uint32_t t = 0; t < from.triangles.size(); ++t) {
    const std::uint32_t placed = document.parts[attributes.part[t]].placed, copy = written.copy_of(placed);
    const NodePlacement& placement = document.placed[placed].placement;
    Triangle there = from.triangles[t];  // in the written copy
    if (copy != no_index && copy != placed) {
      there = from.triangles[written.triangle_of(copy, t)];
      if (document.placed[copy].placement.is_mirrored() != placement.is_mirrored()) std::swap(there[1], there[2]);
    }
    Triangle& corners = level.mesh.triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = from.triangles[t][k];
      const auto [at, is_new] =
          number_of.try_emplace(key_of(placed, there[k]), static_cast<std::uint32_t>(level.mesh.vertices.size()));
      corners[k] = at->second;
      if (!is_new) continue;
      level.source_vertex.push_back(source_vertex[v]);
      const Eigen::Vector3d& p = from.vertices[there[k]];
      level.mesh.vertices.push_back(
          copy == no_index ? p : placement.to_scene(lasting_position(document.placed[copy].placement, p)));
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
  const GltfDocument& document = *attributes.document;
  const std::vector<std::uint32_t> written = document.written_copies();
  std::vector<std::uint8_t> is_invertible;
  double max = 0;
  for (std::uint32_t i = 0; i < document.placed.size(); ++i) {
    const PlacedMesh& placed = document.placed[i];
    is_invertible.push_back(placed.placement.is_invertible() ? 1 : 0);
    if (is_invertible.back() == 0 && written[i] != no_index)  // its written copy rounds the positions
      max = std::max(max, placed.placement.linear.norm() * std::sqrt(3.0) * placed.reach);
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::uint32_t placed = document.parts[attributes.part[t]].placed;
    if (is_invertible[placed] == 0) continue;
    const NodePlacement& placement = document.placed[placed].placement;
    for (const std::uint32_t v : mesh.triangles[t])
      max = std::max(max, placement.linear.norm() * placement.to_node(mesh.vertices[v]).norm());
  }
  return float_rounding * max;
}

}  // namespace meshbound
