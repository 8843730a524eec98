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
/// The state is proven except for that collapse, so only what the collapse touches is compared: its new faces with the
/// original; and the originals that relied on its faces with a few likely faces. Where these do not hold a point, all
/// that is within the tolerance of it is found by boxes and joins them, until they hold all, or nothing is near a
/// point. The boxes are those of an earlier mesh; faces that have changed since then are tested one by one, and the
/// boxes are built again when these become too many.
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
  };
  /// What may be near originals.
  struct Holders {
    std::vector<std::uint32_t> faces, kept;  ///< of the mesh, and originals that are part of the result
  };
  [[nodiscard]] bool exceeds_at(Vec3 placement, Region& region, Proposer& proposer, double tolerance,
                                const DistanceOptions& options);
  [[nodiscard]] Affected affected_by(const EdgeStar& collapsed);
  /// Those that mostly hold the originals: new ones, those beside these, and those that have held the originals.
  [[nodiscard]] std::vector<std::uint32_t> likely_faces(const Affected& affected);
  /// A point of the originals that is not near what may hold them; absent where all of them are.
  [[nodiscard]] std::optional<Vec3> lost_point(const Bvh& originals, const Holders& holders, double tolerance,
                                               const DistanceOptions& options) const;
  [[nodiscard]] bool add_what_is_near(Vec3 point, double tolerance, Holders& holders);
  void make_boxes();

  DecimationState& state_;
  std::optional<FaceBoxes> boxes_;
  std::vector<std::uint32_t> changed_, found_;
  MarkedIds is_changed_;
};

}  // namespace meshbound
