// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <memory>

#include "meshbound/bounds.h"
#include "meshbound/mesh_view.h"

namespace meshbound {

struct BvhOptions {
  int threads = 0;  ///< 0: as many as OpenMP has. The tree is the same for every value.
};

/// A bounding volume hierarchy over a triangle soup, with the adjacency and cells that the Hausdorff engine walks.
/// It keeps its own copy of the geometry; the view may go away after construction. Immutable, so that any number of
/// threads may query it. Build: O(n log n).
class Bvh {
 public:
  /// Throws `InvalidInput` as `validate` does.
  explicit Bvh(const MeshView& mesh, const BvhOptions& options = {});
  Bvh(Bvh&&) noexcept;
  Bvh& operator=(Bvh&&) noexcept;
  ~Bvh();

  [[nodiscard]] std::size_t triangle_count() const;
  [[nodiscard]] const Eigen::AlignedBox3d& bounding_box() const;
  [[nodiscard]] double bounding_box_diagonal() const;
  [[nodiscard]] std::size_t memory_bytes() const;

  struct Data;
  [[nodiscard]] const Data& data() const { return *data_; }

 private:
  std::unique_ptr<const Data> data_;
};

/// The answer of a closest-point query: `point` lies on the mesh up to rounding, and the distance from the query to the
/// mesh lies within `distance`.
struct ClosestPoint {
  SurfacePoint point;
  Bounds distance;
};

/// Expected O(log n). `query` must be finite and within `largest_coordinate`; throws `InvalidInput` otherwise.
[[nodiscard]] ClosestPoint closest_point(const Bvh& bvh, const Eigen::Vector3d& query);

/// A tree under a rigid motion; the tree itself stays as it was built. `bvh` must outlive this.
struct PlacedModel {
  PlacedModel(const Bvh& model, const Eigen::Isometry3d& model_pose = Eigen::Isometry3d::Identity())  // NOLINT
      : bvh(&model), pose(model_pose) {}
  const Bvh* bvh;
  Eigen::Isometry3d pose;
};

}  // namespace meshbound
