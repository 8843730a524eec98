// SPDX-License-Identifier: MIT
#pragma once
#include <deque>
#include <optional>
#include <vector>

#include "levels/level_run.h"
#include "meshbound/attributes.h"

namespace meshbound {

/// One copy of a mesh, and the map from the frame in which the mesh is decimated to the scene.
struct SceneCopy {
  std::uint32_t placed = 0;          ///< of `SceneLayout::placed`
  std::uint32_t first_triangle = 0;  ///< of the original; the copy's triangles follow each other
  bool is_turned = false;            ///< the placement mirrors it: corners 1 and 2 of its triangles are exchanged
};

/// Triangles that are decimated together. A mesh that nodes show more than once is decimated once, in the frame of its
/// node scaled by the largest factor by which a node stretches it: what is within a tolerance there is within it in
/// every copy. All other triangles together are decimated where they stand.
struct SceneGroup {
  TriangleMesh mesh;
  double scale = 1;                      ///< of the frame, if there are copies
  std::vector<SceneCopy> copies;         ///< empty: the triangles are decimated where they stand in the scene
  std::vector<std::uint32_t> vertices;   ///< by vertex of `mesh`: vertex of the original, in the first copy
  std::vector<std::uint32_t> triangles;  ///< by triangle of `mesh`: triangle of the original, in the first copy
};

/// The groups of a scene. If no mesh is shown twice, one group of everything with an empty `mesh`, which stands for the
/// original.
[[nodiscard]] std::vector<SceneGroup> scene_groups(const TriangleMesh& original, const MeshAttributes& attributes);

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
    std::optional<LevelRun> run;
    double seconds = 0;     ///< that its run took
    std::size_t faces = 0;  ///< of its last level, in one copy
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
