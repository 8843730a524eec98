// SPDX-License-Identifier: MIT
/// Pointwise penetration depth of two closed models, after section 7.3 of the paper (meshbound/distance.h).
///
///     V      a connected volume of the intersection of A and B
///     V_A    the part of the boundary of V that lies on A, inside B; V_B the part that lies on B, inside A
///     depth  H(V_A, V_B), the symmetric Hausdorff distance of the two parts
#pragma once
#include <Eigen/Geometry>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "meshbound/bounds.h"
#include "meshbound/bvh.h"
#include "meshbound/distance.h"
#include "meshbound/error.h"
#include "meshbound/mesh_view.h"
#include "meshbound/pose.h"

namespace meshbound {

/// A triangle mesh that bounds a solid, checked once and never changed: a scene makes one for each model and places it
/// as often as it likes. Vertices at equal positions are one vertex. Copies share the data. Any number of threads may
/// use it.
class ClosedModel {
 public:
  /// Copies the mesh and builds its tree. Throws `InvalidInput`, naming the triangles and a place, unless
  ///  - the mesh is one that `validate` accepts,
  ///  - each edge has exactly two triangles, which run along it in opposite directions (closed, consistently oriented),
  ///  - no triangle is without area (one that repeats a position is left out instead, and counts nowhere),
  ///  - no two triangles meet but in a vertex or an edge that both have,
  ///  - normals point out of the solid: those of an outermost component outwards, those of a cavity into it.
  /// All of this is decided exactly. Throws `Stopped` as `BvhOptions::stop` says. O(n log n) for the tree and for
  /// surfaces whose triangles are not much longer than wide.
  explicit ClosedModel(const MeshView& mesh, const BvhOptions& options = {});

  [[nodiscard]] const Bvh& bvh() const;                ///< its tree, over the triangles that were kept
  [[nodiscard]] std::size_t triangle_count() const;    ///< of the mesh as it was given
  [[nodiscard]] std::size_t component_count() const;   ///< sets of triangles that are connected across edges
  [[nodiscard]] double bounding_box_diagonal() const;  ///< model units

  struct Data;
  /// The model itself, for the code of this library.
  [[nodiscard]] const Data& data() const { return *data_; }

 private:
  std::shared_ptr<const Data> data_;
};

/// A closed model under a rigid motion. `model` must outlive this.
struct PlacedClosedModel {
  /// `model_pose` takes model coordinates to world coordinates. What measures with it throws `InvalidInput` where it is
  /// not a rigid motion, or is a reflection.
  PlacedClosedModel(const ClosedModel& closed,  // NOLINT(google-explicit-constructor)
                    const Pose& model_pose = Pose::Identity())
      : model(&closed), pose(model_pose) {}
  const ClosedModel* model;  ///< not owned
  Pose pose;                 ///< from model to world coordinates
};

/// What is asked of a penetration depth, and what it may cost.
struct PenetrationOptions {
  /// Wanted width of the interval of each depth, model units. Absent: 1e-6 of the bounding-box diagonal of A.
  std::optional<double> error_bound;
  /// Only decide whether volumes are deeper than this, model units: each depth is narrowed no further than that needs.
  std::optional<double> decide;
  /// With `decide`: end at the first volume that is deeper; the result then lacks the volumes after it.
  bool stop_when_deeper = false;
  bool keep_parts = false;  ///< return V_A and V_B as meshes
  Budget budget;            ///< of the whole call; cuts of pieces count for each direction of each volume
  int threads = 1;          ///< 0: as many as OpenMP has. Results are the same for every value.
  const std::atomic<bool>* cancel = nullptr;  ///< set to true from another thread or a signal handler to stop early
  /// Called from the calling thread with the share of the intersection volumes that are measured, after each. May call
  /// the library, for the same models too; what it throws ends this call and is passed on.
  std::function<void(double fraction)> progress;
};

/// How the two boundaries of a volume lie to one another.
enum class Overlap {
  Crossing,  ///< the volume has parts of both boundaries
  AInsideB,  ///< a component of A lies inside B: V_A is its surface, V_B the component of B that is next around it
  BInsideA   ///< the other way round
};

/// V_A and V_B as triangles; clipped triangles are cut into several.
struct PenetrationParts {
  TriangleMesh on_a;                         ///< V_A in world coordinates, rounded
  TriangleMesh on_b;                         ///< V_B in world coordinates, rounded
  std::vector<std::uint32_t> triangle_of_a;  ///< by triangle of `on_a`: the triangle of A that it lies on
  std::vector<std::uint32_t> triangle_of_b;  ///< by triangle of `on_b`: the triangle of B that it lies on
};

/// One connected volume of the intersection.
struct PenetrationVolume {
  Bounds depth;       ///< model units
  SurfacePoint on_a;  ///< on V_A, as far from `on_b` as `depth.lower` up to rounding; world coordinates
  SurfacePoint on_b;  ///< on V_B; world coordinates
  Overlap overlap = Overlap::Crossing;    ///< how V_A and V_B were chosen
  std::size_t faces_on_a = 0;             ///< triangles of A that V_A lies on, clipped ones included
  std::size_t faces_on_b = 0;             ///< triangles of B that V_B lies on, clipped ones included
  Bounds volume;                          ///< its content, cubic model units
  Verdict verdict = Verdict::Undecided;   ///< with `decide`: `Exceeds` where it is deeper, `Within` where it is not
  Outcome outcome = Outcome::Converged;   ///< how the measurement of the depth ended
  std::optional<PenetrationParts> parts;  ///< where `keep_parts` asked for them
};

/// What the computation did, and the time of its phases.
struct PenetrationStats {
  std::uint64_t node_pairs = 0;       ///< pairs of tree nodes that were compared
  std::uint64_t triangle_pairs = 0;   ///< pairs of triangles that were tested
  std::uint64_t crossings = 0;        ///< points where an edge of one model goes through a triangle of the other
  std::uint64_t clipped = 0;          ///< triangles of both models that were cut
  std::uint64_t exact_decisions = 0;  ///< signs that needed integer arithmetic
  double seconds_intersecting = 0;    ///< finding and assembling the volumes
  double seconds_measuring = 0;       ///< depths of the volumes
};

/// The volumes that two models have in common.
struct PenetrationDepth {
  std::vector<PenetrationVolume> volumes;  ///< deepest first, by lower bound; empty where the solids share no content
  Bounds depth{0, 0};                      ///< the largest of the depths, 0 where there is none
  /// False: the budget of time ended before the volumes were known; there are none here, and `depth` is [0, infinity].
  bool volumes_known = true;
  PenetrationStats stats;  ///< what was done
};

/// The depth of each connected volume that two closed models have in common, [lower, upper] with the deepest points.
///
/// Which triangles cross, where and in which order is decided exactly, for the images of the vertices under the poses
/// in real arithmetic. What touches without crossing is decided as if A was moved by an infinitesimal vector; volumes
/// without content that come of it are left out, so models that only touch have none. Where faces of both models lie in
/// one plane, their normals on the same side, what they have in common bounds V on both models and counts to V_A and to
/// V_B. Where a component of one model lies inside the other, V has no part of the other boundary; its component that
/// is next around V stands for it (`Overlap`).
///
/// Deterministic for any number of threads, but for a budget of time and `cancel`. Throws `InvalidInput` for lengths
/// that are negative or not a number and for poses that are not rigid motions; `Interrupted` when it is cancelled
/// before the volumes are known. Any number of threads may call it, also with the same models; each keeps scratch
/// memory for its next call. Time: about the triangles near the intersection curves and inside the other model, not
/// those of the models, plus that of `hausdorff_distance` of the parts; a pair that is far apart costs the
/// comparison of two tree nodes.
[[nodiscard]] PenetrationDepth penetration_depth(const PlacedClosedModel& a, const PlacedClosedModel& b,
                                                 const PenetrationOptions& options = {});

/// `penetration_depth` of two meshes, which are checked first. Throws as above and as `ClosedModel`.
[[nodiscard]] PenetrationDepth penetration_depth(const MeshView& a, const MeshView& b,
                                                 const PenetrationOptions& options = {});

/// Whether two solids have a point in common; touching is enough. Decided exactly, for the images of the vertices under
/// the poses in real arithmetic; ends at the first pair of triangles that meet. Throws `InvalidInput` for poses that
/// are not rigid motions. Any number of threads may call it, also with the same models.
[[nodiscard]] bool in_contact(const PlacedClosedModel& a, const PlacedClosedModel& b);

}  // namespace meshbound
