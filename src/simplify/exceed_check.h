// SPDX-License-Identifier: MIT
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "meshbound/distance.h"
#include "numeric/marked_ids.h"
#include "simplify/decimation_state.h"
#include "simplify/proof_workers.h"
#include "simplify/propose.h"

namespace meshbound {

/// Decides by the distance engine whether a refused collapse would really break the bound, for `OnExceed::Stop`: its
/// proof may fail although the bound would hold, with the help of faces that are far away along the surface, and where
/// faces turn at the best placement, an end of the edge may do.
///
/// The state is proven except for that collapse, so only what the collapse touches is compared: the originals that
/// relied on its faces with a few likely faces first, and then with all faces within the tolerance of their box, which
/// are found by boxes; and its new faces with the original. The boxes are those of an earlier mesh; faces that have
/// changed since then are tested one by one, and the boxes are built again when these become too many.
class ExceedCheck {
 public:
  /// `state` must outlive this.
  explicit ExceedCheck(DecimationState& state) : state_(state) {}

  /// False only if the engine finds the mesh after the collapse that `proposer` refused last to be within `tolerance`
  /// of the original: to the placement that was refused, to an end of the edge or to its middle. The mesh is unchanged
  /// afterwards. Expected O(log n), O(n log n) where the boxes are built again.
  [[nodiscard]] bool exceeds(Region& region, Proposer& proposer, double tolerance, const DistanceOptions& options);

  /// To be told of every collapse that is made: the vertex that it has kept.
  void note_change(std::uint32_t kept);

 private:
  /// What a collapse changes: faces around its vertex, and originals that relied on these or on faces that are gone.
  struct Affected {
    std::vector<std::uint32_t> faces, originals;
    Eigen::AlignedBox3d box;  ///< of the originals
  };
  [[nodiscard]] bool exceeds_at(Vec3 placement, Region& region, Proposer& proposer, double tolerance,
                                const DistanceOptions& options);
  [[nodiscard]] Affected affected_by(const EdgeStar& collapsed);
  /// Those that mostly hold the originals: new ones, those beside these, those that have held the originals, and those
  /// near their corners.
  [[nodiscard]] std::vector<std::uint32_t> likely_faces(const Affected& affected, double tolerance);
  void add_faces_near_corners(std::span<const std::uint32_t> originals, double tolerance,
                              std::vector<std::uint32_t>& faces);
  void make_boxes();
  [[nodiscard]] std::vector<std::uint32_t> faces_near(const Eigen::AlignedBox3d& box, double tolerance);

  DecimationState& state_;
  std::optional<FaceBoxes> boxes_;
  std::vector<std::uint32_t> changed_, found_;
  MarkedIds is_changed_;
};

}  // namespace meshbound
