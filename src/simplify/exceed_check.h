// SPDX-License-Identifier: MIT
#pragma once
#include <optional>
#include <vector>

#include "meshbound/distance.h"
#include "simplify/decimation_state.h"
#include "simplify/mesh/marked_ids.h"
#include "simplify/proof_workers.h"
#include "simplify/propose.h"

namespace meshbound {

/// Decides by the distance engine whether a refused collapse really breaks the bound, for `OnExceed::Stop`: the proof
/// of a collapse may fail where the bound still holds, with the help of faces that are far along the surface.
///
/// The state is proven but for that collapse, so only what it touches is compared: the originals that relied on its
/// faces with all faces that lie within the tolerance of their box, found by boxes, and its new faces with the
/// original. Boxes are those of an earlier mesh; faces around vertices that were touched since are looked at one by
/// one, until they are so many that the boxes are made anew.
class ExceedCheck {
 public:
  /// `state` must outlive this.
  explicit ExceedCheck(DecimationState& state) : state_(state) {}

  /// True unless the engine finds the mesh within `tolerance` of the original after the collapse that `proposer` was
  /// refused last. The mesh is as it was afterwards. O(n) with a small constant for n vertices.
  [[nodiscard]] bool exceeds(Region& region, Proposer& proposer, double tolerance, const DistanceOptions& options);

 private:
  void find_changed(const Region& region);
  [[nodiscard]] std::vector<std::uint32_t> faces_near(const Eigen::AlignedBox3d& box, double tolerance);

  DecimationState& state_;
  std::optional<FaceBoxes> boxes_;
  std::uint32_t made_at_ = 0;  ///< clock of the region when the boxes were made
  std::vector<std::uint32_t> changed_, found_;
  MarkedIds is_changed_;
};

}  // namespace meshbound
