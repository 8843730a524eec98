// SPDX-License-Identifier: MIT
#include "levels/scene_run.h"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "levels/measured_level.h"
#include "levels/unchanged_level.h"
#include "mesh/scene_layout.h"
#include "meshbound/mesh_view.h"
#include "numeric/first_error.h"
#include "numeric/no_index.h"
#include "numeric/sort_unique.h"
#include "numeric/tasks.h"
#include "numeric/thread_count.h"
#include "simplify/ended_by.h"

namespace meshbound {
namespace {

/// The tolerances of all levels, ascending, without repetitions; the last one is that of the result.
std::vector<double> tolerances(const SimplifyOptions& options) {
  std::vector<double> all = options.levels;
  all.push_back(options.tolerance);
  sort_unique(all);
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

SceneRun::SceneRun(const TriangleMesh& original, const MeshAttributes& attributes, const SimplifyOptions& options)
    : original_(original), attributes_(attributes), options_(options) {
  const auto start = LevelRun::Clock::now();
  std::optional<GroupOptions> of_groups;
  for (SceneGroup& group : scene_groups(original, attributes)) {
    Group& added = groups_.emplace_back();
    added.group = std::move(group);
    if (!added.is_all() && !of_groups) of_groups.emplace(original, options);
    added.options = of_groups ? of_groups->of(added.group) : options;
    if (!added.group.is_kept) all_faces_ += added.weight(original_);
  }
  share_threads();
  for_each_group([&](Group& of) { of.run.emplace(of.is_all() ? original_ : of.group.mesh, of.options); });
  for (const Group& group : groups_)
    if (group.run) add_lines(group);
  seconds_ = prepare_seconds_ = seconds_since(start);
}

/// Small groups run side by side, each on one thread, and large ones one after the other on all threads. The levels do
/// not depend on it.
void SceneRun::share_threads() {
  const int threads = thread_count(options_.threads);
  // Those that one thread would be left alone with at the end take a quarter of its share at most.
  const std::size_t max_small = all_faces_ / (4 * static_cast<std::size_t>(threads));
  for (Group& group : groups_) {
    if (group.group.is_kept) continue;
    const bool is_small = threads > 1 && group.weight(original_) <= max_small;
    (is_small ? small_ : large_).push_back(&group);
    if (is_small) group.options.threads = 1;
    group.options.progress = {};
    if (!is_small && options_.progress)
      group.options.progress = [this, &group](double share) {
        show(share * static_cast<double>(group.weight(original_)));
      };
  }
  const auto is_heavier = [&](const Group* a, const Group* b) { return a->weight(original_) > b->weight(original_); };
  std::stable_sort(small_.begin(), small_.end(), is_heavier);
}

/// Calls `work` for the run of each group, within the time limit of the whole run.
template <class Work>
void SceneRun::for_each_group(const Work& work) {
  const auto start = LevelRun::Clock::now();
  done_faces_ = 0;
  const auto timed = [&](Group& of) {
    const double before = seconds_ + seconds_since(start);
    of.options.time_limit = options_.time_limit - (before - of.seconds);  // its run subtracts its own time
    work(of);
    of.seconds += seconds_ + seconds_since(start) - before;
    done_faces_ += of.weight(original_);
  };
  for (Group* const group : large_) timed(*group);
  FirstError error;
  on_any_thread(thread_count(options_.threads), small_.size(), [&](std::size_t i) {
    if (error.has_error()) return;
    error.guard([&] {
      timed(*small_[i]);
      if (omp_get_thread_num() == 0) show(0);
    });
  });
  error.rethrow();
  seconds_ += seconds_since(start);
}

/// `faces`: the share of those at hand that is done.
void SceneRun::show(double faces) const {
  if (options_.progress)
    options_.progress((static_cast<double>(done_faces_) + faces) / static_cast<double>(all_faces_));
}

void SceneRun::add_lines(const Group& of) {
  if (of.is_all()) {
    lines_ = of.run->lines();
    return;
  }
  const auto add = [&](const std::vector<std::uint32_t>& vertices) {
    for (const auto& [a, b] : of.run->lines()) lines_.push_back({vertices[a], vertices[b]});
  };
  if (of.group.copies.empty()) add(of.group.vertices);
  for (const SceneCopy& copy : of.group.copies) add(vertices_of_copy(original_, of.group, copy));
}

void SceneRun::append_copy(const Group& of, const SceneCopy& copy, const SimplifiedLevel& part,
                           SimplifiedLevel& level) const {
  const NodePlacement& placement = scene_layout(attributes_)->placed[copy.placed].placement;
  const auto first = static_cast<std::uint32_t>(level.mesh.vertices.size());
  const std::vector<std::uint32_t> vertices = vertices_of_copy(original_, of.group, copy);
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
  level.turned_faces += part.turned_faces;
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
  level.turned_faces += part.turned_faces;
}

SimplifiedLevel SceneRun::unchanged(const Group& of) const {
  SimplifiedLevel part;
  take_unchanged(of.group.mesh, of.options, part);
  return part;
}

SimplifiedLevel SceneRun::next(double tolerance, std::size_t target_faces) {
  const double share = static_cast<double>(target_faces) / static_cast<double>(original_.triangles.size());
  for_each_group([&](Group& of) {
    const auto faces = static_cast<double>(of.weight(original_));
    of.part = of.run->next(tolerance, of.is_all() ? target_faces : static_cast<std::size_t>(std::floor(share * faces)));
  });
  if (groups_.front().is_all()) return std::exchange(groups_.front().part, {});
  SimplifiedLevel level;
  level.tolerance = tolerance;
  level.ended_by = all_faces_ > 0 ? EndedBy::Rounding : EndedBy::NothingFits;
  for (Group& group : groups_) {
    const SimplifiedLevel part = group.run ? std::exchange(group.part, {}) : unchanged(group);
    group.faces = part.faces();
    append(group, part, level);
    if (group.run) level.ended_by = joint_reason(level.ended_by, part.ended_by);
    level.collapses_performed += part.collapses_performed;
    level.collapses_refused += part.collapses_refused;
  }
  return level;
}

void SceneRun::set_texture_tolerance(double tolerance) {
  for (Group& group : groups_)
    if (group.run) group.run->set_texture_tolerance(tolerance);
}

/// A group is told which of its triangles are refuted by their numbers in one copy.
bool SceneRun::take_back(std::span<const Refuted> refuted) {
  if (groups_.front().is_all())
    groups_.front().refuted.assign(refuted.begin(), refuted.end());
  else
    share_out(refuted);
  std::atomic<bool> is_changed = false;
  for_each_group([&](Group& of) {
    if (!of.refuted.empty() && of.run->take_back(of.refuted)) is_changed = true;
    of.refuted.clear();
  });
  return is_changed;
}

void SceneRun::share_out(std::span<const Refuted> refuted) {
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
  for (const Refuted& r : refuted) {
    const auto [group, here] = r.original == no_index ? std::pair<Group*, std::uint32_t>() : of_original[r.original];
    const auto [group_of_face, face_here] = r.face == no_index ? std::pair<Group*, std::uint32_t>() : of_level[r.face];
    if (group != nullptr && group->run)
      group->refuted.push_back({here, group_of_face == group ? face_here : no_index, r.coordinate});
    if (group_of_face != nullptr && group_of_face != group && group_of_face->run)
      group_of_face->refuted.push_back({no_index, face_here, r.coordinate});
  }
}

void SceneRun::describe(SimplifyResult& result) const {
  for (const Group& group : groups_) {
    if (!group.run) continue;
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
  }
  result.seconds.prepare = prepare_seconds_;
  result.seconds.simplify = seconds_ - prepare_seconds_;
  result.lines = lines_;
}

SimplifyResult decimate_levels(const TriangleMesh& original, const SimplifyOptions& options,
                               const MeshAttributes& attributes) {
  check_options(options);
  validate(original);
  SimplifyResult result;
  const std::vector<double> levels = tolerances(options);
  SimplifyOptions of_run = options;
  if (options.progress)
    of_run.progress = [&](double share) {
      options.progress((static_cast<double>(result.levels.size()) + share) / static_cast<double>(levels.size()));
    };
  SceneRun run(original, attributes, of_run);
  for (const double tolerance : levels) {
    const bool is_last = tolerance == levels.back();
    result.levels.push_back(run.next(tolerance, is_last ? target_faces(original, options) : 0));
    if (options.progress) of_run.progress(0);
  }
  run.describe(result);
  return result;
}

}  // namespace meshbound
