// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "meshbound/bounds.h"
#include "meshbound/error.h"
#include "meshbound/mesh_view.h"
#include "meshbound/pose.h"
#include "meshbound/stop_token.h"

namespace meshbound {

/// How a tree is built.
struct BvhOptions {
  int threads = 0;      ///< 0: as many as OpenMP has. The tree is the same for every value.
  StopToken stop = {};  ///< building ends with `Stopped` soon after this says so; a refit goes on
};

/// A bounding volume hierarchy over a triangle soup, with the adjacency and cells that the Hausdorff engine walks:
/// triangles are neighbours across an edge whose ends are the same vertices, or vertices at the same positions.
/// It keeps its own copy of the geometry; the view may go away after construction. Any number of threads may query it,
/// but not during `refit`. Build: O(n log n).
class Bvh {
 public:
  /// Throws `InvalidInput` as `validate` does, `Stopped` as the options say.
  explicit Bvh(const MeshView& mesh, const BvhOptions& options = {});
  Bvh(Bvh&&) noexcept;             ///< a moved-from object may only be destroyed or assigned to
  Bvh& operator=(Bvh&&) noexcept;  ///< a moved-from object may only be destroyed or assigned to
  ~Bvh();

  /// Takes over the vertices of the same mesh after they have moved, at any distance and scale: O(n), without sorting
  /// or finding neighbours again. Queries and distances have the guarantees of a tree that is built anew; as the
  /// triangles are met in another order, bounds may differ inside these guarantees. The same result for any number of
  /// threads. Afterwards `data()` is another object, and what was made from the tree before (`Proximity`) must be made
  /// again; `PlacedModel` and `LevelChecker` follow. Throws `InvalidInput` as `validate` does, and when a triangle
  /// joins other vertices than before; the tree is then as it was.
  void refit(const MeshView& moved, const BvhOptions& options = {});

  /// How much larger the boxes have become since the tree was built, in proportion to the whole model: 1 after
  /// building, about 1 after rigid motions and smooth deformations. Queries slow down with it; once it is beyond 2 or
  /// so, building anew pays. O(n).
  [[nodiscard]] double growth() const;

  [[nodiscard]] std::size_t triangle_count() const;  ///< of the mesh, degenerate and duplicate ones included
  [[nodiscard]] const Eigen::AlignedBox3d& bounding_box() const;  ///< of the vertices that triangles use, model units
  [[nodiscard]] double bounding_box_diagonal() const;             ///< its length, model units

  struct Data;
  /// The tree itself, for the code of this library.
  [[nodiscard]] const Data& data() const { return *data_; }

 private:
  explicit Bvh(std::unique_ptr<const Data> data);
  friend std::pair<Bvh, Bvh> build_trees(const MeshView& a, const MeshView& b, const BvhOptions& options);

  std::unique_ptr<const Data> data_;
};

/// Two trees at once, for the distance between two meshes: those that the constructor builds, but on several threads
/// sooner than one after the other, as each thread builds a tree of its own where the meshes are of like size. Needs
/// the memory of both builds at once. Throws as the constructor, for `a` first.
[[nodiscard]] std::pair<Bvh, Bvh> build_trees(const MeshView& a, const MeshView& b, const BvhOptions& options = {});

/// The answer of a closest-point query: `point` lies on the mesh up to rounding, and the distance from the query to the
/// mesh lies within `distance`.
struct ClosestPoint {
  SurfacePoint point;  ///< model coordinates
  Bounds distance;     ///< model units
};

/// The point of the mesh that is closest to `query` (model coordinates). Expected O(log n). `query` must be finite and
/// within `largest_coordinate`; throws `InvalidInput` otherwise. A thread begins its search at the triangle that it
/// found last in the same tree, so queries near one another are fast; answers do not depend on it. Of triangles equally
/// near, the same one is named each time. Any number of threads may call it.
[[nodiscard]] ClosestPoint closest_point(const Bvh& bvh, const Eigen::Vector3d& query);

/// How queries are answered.
struct QueryOptions {
  int threads = 0;      ///< 0: as many as OpenMP has. The answers are the same for every value.
  StopToken stop = {};  ///< `closest_points` throws `Stopped` within a few queries once this says so
};

/// `closest_point` for each of many queries, with the same answers to the last bit. Each search begins at the triangle
/// that the query before it found, and up to sixteen queries near one another share a walk over the tree. Queries whose
/// neighbours do not follow one another are answered in the order of a space-filling curve. Throws `InvalidInput` as
/// above when one of the queries is to be refused, `Stopped` as the options say. Expected O(log n) for each.
[[nodiscard]] std::vector<ClosestPoint> closest_points(const Bvh& bvh, std::span<const Eigen::Vector3d> queries,
                                                       const QueryOptions& options = {});

/// A tree under a rigid motion; the tree itself stays as it was built. `bvh` must outlive this.
struct PlacedModel {
  /// `model_pose` takes model coordinates to world coordinates. What measures with it throws `InvalidInput` where it is
  /// not a rigid motion.
  PlacedModel(const Bvh& model, const Pose& model_pose = Pose::Identity())  // NOLINT
      : bvh(&model), pose(model_pose) {}
  const Bvh* bvh;  ///< not owned
  Pose pose;       ///< from model to world coordinates
};

}  // namespace meshbound
