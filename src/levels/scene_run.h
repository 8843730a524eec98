// SPDX-License-Identifier: MIT
#pragma once
#include <atomic>
#include <deque>
#include <optional>
#include <vector>

#include "levels/group_options.h"
#include "levels/level_run.h"
#include "levels/scene_groups.h"
#include "meshbound/attributes.h"

namespace meshbound {

/// Number of faces at which the last level ends; 0 if the options have no target.
[[nodiscard]] std::size_t target_faces(const TriangleMesh& original, const SimplifyOptions& options);

/// Makes the levels of an original as `LevelRun` does, and keeps copies of a mesh copies of each other. Not
/// thread-safe.
class SceneRun {
 public:
  /// The arguments must outlive this. Throws as `LevelRun`.
  SceneRun(const TriangleMesh& original, const MeshAttributes& attributes, const SimplifyOptions& options);

  /// As `LevelRun::next`. A target counts the faces shown, and each group gets its share of it.
  [[nodiscard]] SimplifiedLevel next(double tolerance, std::size_t target_faces);
  /// As `LevelRun::set_texture_tolerance`.
  void set_texture_tolerance(double tolerance);
  /// As `LevelRun::take_back`, in all copies of a mesh.
  [[nodiscard]] bool take_back(std::span<const Refuted> refuted);
  [[nodiscard]] const std::vector<Edge>& lines() const { return lines_; }
  void describe(SimplifyResult& result) const;

 private:
  struct Group {
    SceneGroup group;
    SimplifyOptions options;
    std::optional<LevelRun> run;   ///< none: its triangles are kept
    SimplifiedLevel part;          ///< of the level at hand
    std::vector<Refuted> refuted;  ///< of its last level, not taken back yet
    double seconds = 0;            ///< that its run took
    std::size_t faces = 0;         ///< of its last level, in one copy

    /// Whether it is the only one and its mesh the original.
    [[nodiscard]] bool is_all() const { return group.triangles.empty(); }
    /// Triangles of its mesh.
    [[nodiscard]] std::size_t weight(const TriangleMesh& original) const {
      return is_all() ? original.triangles.size() : group.triangles.size();
    }
  };

  void share_threads();
  template <class Work>
  void for_each_group(const Work& work);
  void show(double faces) const;
  [[nodiscard]] SimplifiedLevel unchanged(const Group& of) const;
  void share_out(std::span<const Refuted> refuted);
  void add_lines(const Group& of);
  void append(const Group& of, const SimplifiedLevel& part, SimplifiedLevel& level) const;
  void append_copy(const Group& of, const SceneCopy& copy, const SimplifiedLevel& part, SimplifiedLevel& level) const;

  const TriangleMesh& original_;
  const MeshAttributes& attributes_;
  const SimplifyOptions& options_;
  std::deque<Group> groups_;                 ///< never moved: runs refer to them
  std::vector<Group*> large_, small_;        ///< run one after the other, and side by side
  std::size_t all_faces_ = 0;                ///< of the meshes of all groups
  std::atomic<std::size_t> done_faces_ = 0;  ///< those of the step at hand that is done
  double seconds_ = 0;                       ///< that all runs took by the clock
  double prepare_seconds_ = 0;               ///< of these, until the first level
  std::vector<Edge> lines_;
};

}  // namespace meshbound
