// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "geometry/triangle_corners.h"
#include "meshbound/proximity.h"
#include "numeric/marked_ids.h"
#include "simplify/decimation_state.h"
#include "simplify/mesh/normal_guard.h"
#include "simplify/propose.h"
#include "simplify/regions.h"
#include "simplify/star_samples.h"

namespace meshbound {

/// One change of a few faces: a vertex moved, an edge flipped or collapsed. Its faces are gathered and placed, compared
/// with the samples around them, and changed; then they get the samples, or the caller takes the change back because it
/// could not prove it. One for each thread.
class LocalEdit {
 public:
  explicit LocalEdit(DecimationState& state);
  /// Selects the region in which changes are made. Both arguments must stay where they are until the last change.
  void enter(const Split& split, Region& region);

  /// Gather the faces around, before the change. False if borders, locks, the region or the topology forbid the change,
  /// and for the collapse of a border edge.
  [[nodiscard]] bool gather_move(std::uint32_t vertex);
  [[nodiscard]] bool gather_flip(Corner edge);
  [[nodiscard]] bool gather_collapse(Corner edge);

  /// Places the faces that stay with the vertex at `point`, or the edge flipped. False if a face would be folded.
  [[nodiscard]] bool place(Vec3 point);
  [[nodiscard]] bool place_flipped();
  /// Gathers and places a flip. False if it is not possible or would not lower the deviation.
  [[nodiscard]] bool flip_lowers_deviation(Corner edge);
  /// The vertex that moves comes first in each of these faces.
  [[nodiscard]] std::span<const TriangleCorners> faces() const { return corners_; }
  /// The position of the moving vertex before the change.
  [[nodiscard]] Vec3 origin() const { return origin_; }

  /// The sum over the samples, and over points on the edges that change, of (distance / tolerance)^6: a high power
  /// follows the largest distance and stays smooth. A guide, not a bound. Edges are left out once the sum reaches
  /// `enough`.
  [[nodiscard]] DeviationSums deviation(double enough = HUGE_VAL);
  /// The part of that sum that stands for samples.
  [[nodiscard]] DeviationSums sampled_deviation() const;
  /// Whether the samples, and points on the edges that change, are within `share` of what has to be proven. Tests many
  /// more points of the edges than `deviation`: most proofs of a promising change fail between the samples.
  [[nodiscard]] bool fits(double share);

  /// Makes the change in the mesh, as placed last.
  void make();
  /// Assigns the samples to their nearest faces, once the change is final.
  void assign_samples();
  /// The faces that the change has altered or removed.
  [[nodiscard]] std::span<const std::uint32_t> changed_faces() const { return taken_; }

  /// Starts a group: a collapse, gathered and placed, together with changes around it that make room for it. Their
  /// samples are assigned at once, and they are kept or undone together.
  void begin_group();
  /// As `fits`, for all faces of the group.
  [[nodiscard]] bool group_fits(double share);
  /// The faces that its changes have altered or removed.
  [[nodiscard]] std::span<const std::uint32_t> group() const { return group_; }
  void keep_group();
  void undo_group();

 private:
  void begin();
  void take_face(std::uint32_t face);
  void take_beside(Corner rim);
  void add_point(Vec3 p, std::uint32_t near, double share, DeviationSums& sums) const;
  /// What an edge from the vertex is compared with, also while the vertex is moved about: a walk for each place takes
  /// 1.1 of the time, and leaves as many faces (eight meshes at 0.1%).
  struct BelowEdge {
    bool is_known = false;  ///< a walk led below the edge to its end
    double share = 0;       ///< of what the vertex moves, where the edge was farthest from the original
    Vec3 corner, normal;    ///< the plane of the original there, `normal` of unit length; zero where none is needed
  };
  [[nodiscard]] BelowEdge below_edge(Vec3 vertex, Vec3 end, std::uint32_t near);
  void add_edge(Vec3 vertex, Vec3 end, const BelowEdge& below, DeviationSums& sums);
  [[nodiscard]] std::uint32_t original_near(Vec3 p, std::uint32_t hint);
  [[nodiscard]] std::span<const TriangleCorners> changing_edges() const;
  [[nodiscard]] bool owns(std::uint32_t vertex) const { return split_->owns(region_->id, vertex); }
  /// The face of this corner, whose vertex moves, as it is before the change.
  [[nodiscard]] GuardedFace guarded_face(Corner moved) const {
    return {state_.mesh, moved, [this](std::uint32_t face) { return split_->owns_face(region_->id, face); }};
  }
  [[nodiscard]] bool owns_around(std::uint32_t vertex) const;
  [[nodiscard]] bool has_edge(std::uint32_t a, std::uint32_t b) const;
  [[nodiscard]] bool may_move(std::uint32_t vertex) const;
  void set_faces();
  void touch(std::span<const std::uint32_t> faces);
  void join_group();

  DecimationState& state_;
  const Split* split_ = nullptr;
  Region* region_ = nullptr;
  StarSamples samples_;
  Proximity proximity_;
  SampleKernel kernel_ = simplify_kernels().samples;

  Edit::Kind kind_ = Edit::Kind::Move;
  EdgeStar star_;  ///< of a collapse
  Corner edge_ = 0;
  Vec3 origin_;
  std::vector<std::uint32_t> taken_, numbers_, beside_;  ///< faces that change, those of them that stay, and others
  std::vector<GuardedFace> before_;                      ///< faces that stay
  std::vector<TriangleCorners> corners_;                 ///< of the faces that stay, as they would be
  std::vector<SampleFace> faces_;                        ///< `corners_` relative to the origin
  std::vector<BelowEdge> below_edges_;                   ///< of the edges that change, as far as they are known
  std::uint32_t near_ = 0;                               ///< an original near the vertex that moves

  bool grouped_ = false;
  Quadric quadric_before_;  ///< of the vertex that the collapse of the group keeps
  MarkedIds is_of_group_;
  std::vector<std::uint32_t> group_;                                   ///< faces
  std::vector<std::pair<std::uint32_t, std::uint32_t>> owned_before_;  ///< samples and their faces before the group
};

}  // namespace meshbound
