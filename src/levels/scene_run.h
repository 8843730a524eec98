// SPDX-License-Identifier: MIT
#pragma once
#include <deque>
#include <optional>
#include <vector>

#include "levels/level_run.h"
#include "meshbound/attributes.h"

namespace meshbound {

/// Where a copy of a mesh stands: from the frame in which the mesh is decimated to the scene.
struct SceneCopy {
  std::uint32_t placed = 0;          ///< of `SceneLayout::placed`
  std::uint32_t first_triangle = 0;  ///< of the original; the copy's triangles follow each other
  bool is_turned = false;            ///< its triangles have their corners 1 and 2 exchanged, as it is mirrored
};

/// Triangles that are decimated together. A mesh that nodes show more than once is decimated once, in the frame of its
/// node scaled by the largest factor by which a node stretches it: what is within a tolerance there is within it in
/// every copy. All other triangles together are decimated where they stand.
struct SceneGroup {
  TriangleMesh mesh;
  double scale = 1;                      ///< of the frame, where there are copies
  std::vector<SceneCopy> copies;         ///< empty: the triangles as they stand in the scene
  std::vector<std::uint32_t> vertices;   ///< of the original, by vertex of `mesh`; those of the first copy
  std::vector<std::uint32_t> triangles;  ///< of the original, by triangle of `mesh`; those of the first copy
};

/// One group of everything where no mesh is shown twice; it then has an empty `mesh`, which stands for the original.
[[nodiscard]] std::vector<SceneGroup> scene_groups(const TriangleMesh& original, const MeshAttributes& attributes);

/// The levels of an original, one after the other, as `LevelRun`, but copies of a mesh stay copies. Not thread-safe.
class SceneRun {
 public:
  /// All must outlive this. Throws as `LevelRun`.
  SceneRun(const TriangleMesh& original, const MeshAttributes& attributes, const SimplifyOptions& options);

  /// As `LevelRun::next`. The faces of a target are those that are shown, each group taking its share of them.
  [[nodiscard]] SimplifiedLevel next(double tolerance, std::size_t target_faces);
  [[nodiscard]] const std::vector<Edge>& lines() const { return lines_; }
  void describe(SimplifyResult& result) const;

 private:
  struct Group {
    SceneGroup group;
    SimplifyOptions options;
    std::optional<LevelRun> run;
    double seconds = 0;  ///< that the run took
  };

  template <class Work>
  void timed(Group& of, const Work& work);
  void start(Group& of);
  void add_lines(const Group& of);
  void append(const Group& of, const SimplifiedLevel& part, SimplifiedLevel& level) const;
  void append_copy(const Group& of, const SceneCopy& copy, const SimplifiedLevel& part, SimplifiedLevel& level) const;
  [[nodiscard]] std::vector<std::uint32_t> vertices_of(const Group& of, const SceneCopy& copy) const;

  const TriangleMesh& original_;
  const MeshAttributes& attributes_;
  const SimplifyOptions& options_;
  std::deque<Group> groups_;  ///< never moved: runs refer to them
  double seconds_ = 0;        ///< that all runs took
  std::vector<Edge> lines_;
};

}  // namespace meshbound
