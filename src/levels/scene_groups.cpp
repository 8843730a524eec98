// SPDX-License-Identifier: MIT
#include "levels/scene_groups.h"

#include <Eigen/SVD>
#include <algorithm>
#include <map>

#include "mesh/first_use.h"
#include "mesh/scene_layout.h"

namespace meshbound {
namespace {

double largest_stretch(const NodePlacement& placement) {
  return Eigen::JacobiSVD<Eigen::Matrix3d>(placement.linear).singularValues()[0];
}

/// By placed mesh: its triangles in the original.
std::vector<std::vector<std::uint32_t>> triangles_by_placed(const SceneLayout& layout,
                                                            const std::vector<std::uint32_t>& part_of_triangle) {
  std::vector<std::vector<std::uint32_t>> result(layout.placed.size());
  for (std::uint32_t t = 0; t < part_of_triangle.size(); ++t)
    result[layout.parts[part_of_triangle[t]].placed].push_back(t);
  return result;
}

/// Fills vertices and triangles of a group from its triangles of the original. `number`: of vertices of the original,
/// without any before and after.
void take_triangles(SceneGroup& group, const TriangleMesh& original, FirstUse& number) {
  for (const std::uint32_t t : group.triangles) group.mesh.triangles.push_back(number(original.triangles[t]));
  group.vertices = number.used();
  for (const std::uint32_t v : group.vertices) group.mesh.vertices.push_back(original.vertices[v]);
  number.clear();
}

SceneGroup group_of_copies(const TriangleMesh& original, const SceneLayout& layout,
                           const std::vector<std::uint32_t>& placed,
                           const std::vector<std::vector<std::uint32_t>>& triangles, FirstUse& number) {
  SceneGroup group;
  const NodePlacement& first = layout.placed[placed.front()].placement;
  group.scale = 0;
  for (const std::uint32_t p : placed) {
    const NodePlacement& placement = layout.placed[p].placement;
    group.scale = std::max(group.scale, largest_stretch(placement));
    group.copies.push_back({p, triangles[p].front(), placement.is_mirrored() != first.is_mirrored()});
  }
  group.triangles = triangles[placed.front()];
  take_triangles(group, original, number);
  for (Eigen::Vector3d& p : group.mesh.vertices) p = group.scale * first.to_node(p);
  return group;
}

}  // namespace

std::vector<SceneGroup> scene_groups(const TriangleMesh& original, const MeshAttributes& attributes) {
  std::vector<SceneGroup> groups(1);
  if (attributes.document == nullptr) return groups;
  const SceneLayout& layout = *scene_layout(attributes);
  const auto triangles = triangles_by_placed(layout, attributes.part);
  FirstUse number(original.vertices.size());
  SceneGroup kept;
  kept.is_kept = true;
  const std::vector<std::uint32_t> written = layout.written_copies();
  // Copies of each mesh; the one that is written comes first.
  std::map<std::uint32_t, std::vector<std::uint32_t>> placed_of;
  for (std::uint32_t p = 0; p < layout.placed.size(); ++p)
    if (!triangles[p].empty()) placed_of[layout.placed[p].mesh].push_back(p);
  for (auto& [mesh, placed] : placed_of) {
    const auto first = std::find(placed.begin(), placed.end(), written[placed.front()]);
    if (placed.size() > 1 && first != placed.end()) {
      std::rotate(placed.begin(), first, first + 1);
      groups.push_back(group_of_copies(original, layout, placed, triangles, number));
    } else {
      std::vector<std::uint32_t>& to = first != placed.end() ? groups.front().triangles : kept.triangles;
      for (const std::uint32_t p : placed) to.insert(to.end(), triangles[p].begin(), triangles[p].end());
    }
  }
  if (groups.size() == 1 && kept.triangles.empty()) return std::vector<SceneGroup>(1);
  groups.push_back(std::move(kept));
  for (SceneGroup* const group : {&groups.front(), &groups.back()}) {
    std::sort(group->triangles.begin(), group->triangles.end());
    take_triangles(*group, original, number);
  }
  if (groups.back().triangles.empty()) groups.pop_back();
  if (groups.front().triangles.empty()) groups.erase(groups.begin());
  return groups;
}

std::vector<std::uint32_t> vertices_of_copy(const TriangleMesh& original, const SceneGroup& group,
                                            const SceneCopy& copy) {
  std::vector<std::uint32_t> result(group.vertices.size(), 0);
  for (std::size_t i = 0; i < group.mesh.triangles.size(); ++i) {
    Triangle there = original.triangles[copy.first_triangle + i];
    if (copy.is_turned) std::swap(there[1], there[2]);
    for (std::size_t k = 0; k < 3; ++k) result[group.mesh.triangles[i][k]] = there[k];
  }
  return result;
}

}  // namespace meshbound
