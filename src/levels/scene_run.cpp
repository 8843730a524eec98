// SPDX-License-Identifier: MIT
#include "levels/scene_run.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <map>

#include "levels/measured_level.h"
#include "mesh/scene_layout.h"
#include "meshbound/error.h"
#include "meshbound/mesh_view.h"
#include "numeric/no_index.h"
#include "simplify/ended_by.h"

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

/// Fills vertices and triangles of a group from its triangles of the original.
void take_triangles(SceneGroup& group, const TriangleMesh& original) {
  std::vector<std::uint32_t> number(original.vertices.size(), no_index);
  for (const std::uint32_t t : group.triangles) {
    Triangle& corners = group.mesh.triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = original.triangles[t][k];
      if (number[v] == no_index) {
        number[v] = static_cast<std::uint32_t>(group.vertices.size());
        group.vertices.push_back(v);
        group.mesh.vertices.push_back(original.vertices[v]);
      }
      corners[k] = number[v];
    }
  }
}

SceneGroup group_of_copies(const TriangleMesh& original, const SceneLayout& layout,
                           const std::vector<std::uint32_t>& placed,
                           const std::vector<std::vector<std::uint32_t>>& triangles) {
  SceneGroup group;
  const NodePlacement& first = layout.placed[placed.front()].placement;
  group.scale = 0;
  for (const std::uint32_t p : placed) {
    const NodePlacement& placement = layout.placed[p].placement;
    group.scale = std::max(group.scale, largest_stretch(placement));
    group.copies.push_back({p, triangles[p].front(), placement.is_mirrored() != first.is_mirrored()});
  }
  group.triangles = triangles[placed.front()];
  take_triangles(group, original);
  for (Eigen::Vector3d& p : group.mesh.vertices) p = group.scale * first.to_node(p);
  return group;
}

/// The tolerances of all levels, ascending, without repetitions; the last one is that of the result.
std::vector<double> tolerances(const SimplifyOptions& options) {
  std::vector<double> all = options.levels;
  all.push_back(options.tolerance);
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

}  // namespace

std::size_t target_faces(const TriangleMesh& original, const SimplifyOptions& options) {
  std::size_t faces = options.target_faces.value_or(0);
  if (options.target_ratio) {
    const double share = *options.target_ratio * static_cast<double>(original.triangles.size());
    faces = std::max(faces, static_cast<std::size_t>(std::floor(share)));
  }
  return faces;
}

std::vector<SceneGroup> scene_groups(const TriangleMesh& original, const MeshAttributes& attributes) {
  std::vector<SceneGroup> groups(1);
  if (attributes.document == nullptr) return groups;
  const SceneLayout& layout = *scene_layout(attributes);
  const auto triangles = triangles_by_placed(layout, attributes.part);
  // Copies of each mesh; the first one has an invertible placement. Meshes without one are invisible and stay as they
  // are.
  std::map<std::uint32_t, std::vector<std::uint32_t>> placed_of;
  for (std::uint32_t p = 0; p < layout.placed.size(); ++p)
    if (!triangles[p].empty()) placed_of[layout.placed[p].mesh].push_back(p);
  for (auto& [mesh, placed] : placed_of) {
    const auto invertible = std::find_if(placed.begin(), placed.end(),
                                         [&](std::uint32_t p) { return layout.placed[p].placement.is_invertible(); });
    if (placed.size() > 1 && invertible != placed.end()) {
      std::rotate(placed.begin(), invertible, invertible + 1);
      groups.push_back(group_of_copies(original, layout, placed, triangles));
    } else {
      for (const std::uint32_t p : placed)
        groups.front().triangles.insert(groups.front().triangles.end(), triangles[p].begin(), triangles[p].end());
    }
  }
  if (groups.size() == 1) return std::vector<SceneGroup>(1);
  std::sort(groups.front().triangles.begin(), groups.front().triangles.end());
  take_triangles(groups.front(), original);
  if (groups.front().triangles.empty()) groups.erase(groups.begin());
  return groups;
}

SceneRun::SceneRun(const TriangleMesh& original, const MeshAttributes& attributes, const SimplifyOptions& options)
    : original_(original), attributes_(attributes), options_(options) {
  for (SceneGroup& group : scene_groups(original, attributes)) {
    Group& added = groups_.emplace_back();
    added.group = std::move(group);
    added.options = options;
    timed(added, [&] {
      if (added.group.triangles.empty())
        added.run.emplace(original, added.options);
      else
        start(added);
    });
    add_lines(added);
  }
}

/// Runs `work` within the time limit of the whole run, of which each group's run subtracts only its own time.
template <class Work>
void SceneRun::timed(Group& of, const Work& work) {
  const auto start = LevelRun::Clock::now();
  of.options.time_limit = options_.time_limit - (seconds_ - of.seconds);
  work();
  const double seconds = seconds_since(start);
  of.seconds += seconds;
  seconds_ += seconds;
}

/// Starts the run of a group. Options refer to vertices and triangles of the original, so they are translated to those
/// of the group.
void SceneRun::start(Group& of) {
  const SceneGroup& group = of.group;
  std::vector<std::uint32_t> number(original_.vertices.size(), no_index);  // in the group, of all of its copies
  const auto add = [&](const std::vector<std::uint32_t>& vertices) {
    for (std::uint32_t v = 0; v < vertices.size(); ++v) number[vertices[v]] = v;
  };
  add(group.vertices);
  for (const SceneCopy& copy : group.copies) add(vertices_of(of, copy));
  of.options.feature_edges.clear();
  for (const auto& [a, b] : options_.feature_edges) {
    if (std::max(a, b) >= number.size())
      throw InvalidInput("a feature edge refers to vertex " + std::to_string(std::max(a, b)) + ", but there are only " +
                         std::to_string(number.size()));
    if (number[a] != no_index && number[b] != no_index) of.options.feature_edges.push_back({number[a], number[b]});
  }
  const auto take = [&](const auto& from, auto& to) {  // by triangle
    if (from.empty()) return;
    to.clear();
    for (const std::uint32_t t : group.triangles) to.push_back(from[t]);
  };
  if (!options_.locked_vertices.empty()) {
    if (options_.locked_vertices.size() != number.size())
      throw InvalidInput("the locked vertices must be given for every vertex of the original, or not at all");
    of.options.locked_vertices.assign(group.vertices.size(), false);
    for (std::uint32_t v = 0; v < number.size(); ++v)
      if (number[v] != no_index && options_.locked_vertices[v]) of.options.locked_vertices[number[v]] = true;
  }
  if (!options_.face_tolerances.empty() && options_.face_tolerances.size() != original_.triangles.size())
    throw InvalidInput("tolerances of triangles must be given for every triangle of the original");
  take(options_.face_tolerances, of.options.face_tolerances);
  for (const SceneCopy& copy : group.copies)
    for (std::uint32_t i = 0; i < of.options.face_tolerances.size(); ++i) {
      double& tolerance = of.options.face_tolerances[i];
      tolerance = std::min(tolerance, options_.face_tolerances[copy.first_triangle + i]);
    }
  take(options_.texture_coordinates, of.options.texture_coordinates);
  take(options_.materials, of.options.materials);
  of.run.emplace(group.mesh, of.options);
}

/// For each vertex of a group's mesh, the vertex of the original in one of its copies.
std::vector<std::uint32_t> SceneRun::vertices_of(const Group& of, const SceneCopy& copy) const {
  std::vector<std::uint32_t> result(of.group.vertices.size(), 0);
  for (std::size_t i = 0; i < of.group.mesh.triangles.size(); ++i) {
    Triangle there = original_.triangles[copy.first_triangle + i];
    if (copy.is_turned) std::swap(there[1], there[2]);
    for (std::size_t k = 0; k < 3; ++k) result[of.group.mesh.triangles[i][k]] = there[k];
  }
  return result;
}

void SceneRun::add_lines(const Group& of) {
  if (of.group.triangles.empty()) {
    lines_ = of.run->lines();
    return;
  }
  const auto add = [&](const std::vector<std::uint32_t>& vertices) {
    for (const auto& [a, b] : of.run->lines()) lines_.push_back({vertices[a], vertices[b]});
  };
  if (of.group.copies.empty()) add(of.group.vertices);
  for (const SceneCopy& copy : of.group.copies) add(vertices_of(of, copy));
}

void SceneRun::append_copy(const Group& of, const SceneCopy& copy, const SimplifiedLevel& part,
                           SimplifiedLevel& level) const {
  const NodePlacement& placement = scene_layout(attributes_)->placed[copy.placed].placement;
  const auto first = static_cast<std::uint32_t>(level.mesh.vertices.size());
  const std::vector<std::uint32_t> vertices = vertices_of(of, copy);
  for (const Eigen::Vector3d& p : part.mesh.vertices)
    level.mesh.vertices.push_back(placement.to_scene(p / of.group.scale));
  for (const std::uint32_t v : part.source_vertex) level.source_vertex.push_back(vertices[v]);
  for (Triangle t : part.mesh.triangles) {
    if (copy.is_turned) std::swap(t[1], t[2]);
    level.mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  for (const std::uint32_t t : part.source_triangle) level.source_triangle.push_back(copy.first_triangle + t);
  for (auto corners : part.texture_coordinates) {
    if (copy.is_turned) std::swap(corners[1], corners[2]);
    level.texture_coordinates.push_back(corners);
  }
  for (const auto& [a, b] : part.lines) level.lines.push_back({a + first, b + first});
}

void SceneRun::append(const Group& of, const SimplifiedLevel& part, SimplifiedLevel& level) const {
  for (const SceneCopy& copy : of.group.copies) append_copy(of, copy, part, level);
  if (!of.group.copies.empty()) return;
  const auto first = static_cast<std::uint32_t>(level.mesh.vertices.size());
  level.mesh.vertices.insert(level.mesh.vertices.end(), part.mesh.vertices.begin(), part.mesh.vertices.end());
  for (const std::uint32_t v : part.source_vertex) level.source_vertex.push_back(of.group.vertices[v]);
  for (const Triangle& t : part.mesh.triangles)
    level.mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  for (const std::uint32_t t : part.source_triangle) level.source_triangle.push_back(of.group.triangles[t]);
  level.texture_coordinates.insert(level.texture_coordinates.end(), part.texture_coordinates.begin(),
                                   part.texture_coordinates.end());
  for (const auto& [a, b] : part.lines) level.lines.push_back({a + first, b + first});
}

SimplifiedLevel SceneRun::next(double tolerance, std::size_t target_faces) {
  if (groups_.size() == 1 && groups_.front().group.triangles.empty())
    return groups_.front().run->next(tolerance, target_faces);
  SimplifiedLevel level;
  level.tolerance = tolerance;
  level.ended_by = EndedBy::Rounding;
  const double share = static_cast<double>(target_faces) / static_cast<double>(original_.triangles.size());
  for (Group& group : groups_) {
    const auto faces = static_cast<double>(group.group.mesh.triangles.size());
    SimplifiedLevel part;
    timed(group, [&] { part = group.run->next(tolerance, static_cast<std::size_t>(std::floor(share * faces))); });
    group.faces = part.faces();
    append(group, part, level);
    level.ended_by = joint_reason(level.ended_by, part.ended_by);
    level.collapses_performed += part.collapses_performed;
    level.collapses_refused += part.collapses_refused;
  }
  return level;
}

void SceneRun::set_texture_tolerance(double tolerance) {
  for (Group& group : groups_) group.run->set_texture_tolerance(tolerance);
}

/// A group is told which of its triangles are refuted by their numbers in one copy.
bool SceneRun::take_back(std::span<const Refuted> refuted) {
  if (groups_.size() == 1 && groups_.front().group.triangles.empty()) return groups_.front().run->take_back(refuted);
  std::vector<std::pair<Group*, std::uint32_t>> of_level, of_original(original_.triangles.size());
  for (Group& group : groups_) {
    const std::size_t copies = std::max<std::size_t>(group.group.copies.size(), 1);
    for (std::size_t i = 0; i < copies * group.faces; ++i)
      of_level.emplace_back(&group, static_cast<std::uint32_t>(i % group.faces));
    for (std::uint32_t i = 0; i < group.group.triangles.size(); ++i) {
      of_original[group.group.triangles[i]] = {&group, i};
      for (const SceneCopy& copy : group.group.copies) of_original[copy.first_triangle + i] = {&group, i};
    }
  }
  std::map<Group*, std::vector<Refuted>> by_group;
  for (const Refuted& r : refuted) {
    const auto [group, here] = r.original == no_index ? std::pair<Group*, std::uint32_t>() : of_original[r.original];
    const auto [group_of_face, face_here] = r.face == no_index ? std::pair<Group*, std::uint32_t>() : of_level[r.face];
    if (group != nullptr)
      by_group[group].push_back({here, group_of_face == group ? face_here : no_index, r.coordinate});
    if (group_of_face != nullptr && group_of_face != group)
      by_group[group_of_face].push_back({no_index, face_here, r.coordinate});
  }
  bool is_changed = false;
  for (const auto& item : by_group) {
    Group& group = *item.first;
    timed(group, [&] { is_changed = group.run->take_back(item.second) || is_changed; });
  }
  return is_changed;
}

void SceneRun::describe(SimplifyResult& result) const {
  for (const Group& group : groups_) {
    SimplifyResult part;
    group.run->describe(part);
    result.dropped_triangles += part.dropped_triangles;
    result.kept_triangles += part.kept_triangles;
    result.pruned_components += part.pruned_components;
    result.pruned_faces += part.pruned_faces;
    result.locked_vertices += part.locked_vertices;
    result.split = result.split || part.split;
    result.tolerance_below_rounding = result.tolerance_below_rounding || part.tolerance_below_rounding;
    result.counts += part.counts;
    result.seconds.prepare += part.seconds.prepare;
    result.seconds.simplify += part.seconds.simplify;
  }
  result.lines = lines_;
}

SimplifyResult decimate_levels(const TriangleMesh& original, const SimplifyOptions& options,
                               const MeshAttributes& attributes) {
  check_options(options);
  validate(original);
  SimplifyResult result;
  SceneRun run(original, attributes, options);
  const std::vector<double> levels = tolerances(options);
  for (const double tolerance : levels) {
    const bool is_last = tolerance == levels.back();
    result.levels.push_back(run.next(tolerance, is_last ? target_faces(original, options) : 0));
    if (options.progress)
      options.progress(static_cast<double>(result.levels.size()) / static_cast<double>(levels.size()));
  }
  run.describe(result);
  return result;
}

}  // namespace meshbound
