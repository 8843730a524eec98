// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "meshbound/triangle_mesh.h"
#include "proof/parity_patch.h"

namespace meshbound {

/// Proves that a face lies within a tolerance of the original by a parity (proof/parity_patch.h) over T', the face a
/// little shrunk.
///
/// Rounding. It is the heights that carry the error of the projection, and tests against T' keep a rim that is wider
/// than theirs (`covers`). Not thread-safe.
class ParityProof {
 public:
  /// Shrinking the face costs this share of the tolerance. It keeps walls that stand on an edge of the face, as at the
  /// creases of machined parts, out of the prism.
  static constexpr double shrink_share = 1e-3;

  /// Takes the corners and triangles of the original and its `edge_neighbours`. O(n). The arguments must outlive this.
  ParityProof(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles,
              const std::vector<std::array<std::uint32_t, 3>>& neighbours);

  /// True proves that `face` lies within `tolerance` of the original (but for CandidateFaces::rounding_slack of the
  /// largest coordinate); false says nothing. P grows from `seed` over the edges that project onto the face.
  [[nodiscard]] bool covers(const std::array<Vec3, 3>& face, double tolerance, double magnitude, std::uint32_t seed);

 private:
  struct Sight;
  [[nodiscard]] bool set_view(const std::array<Vec3, 3>& face, double tolerance, double magnitude);

  const std::vector<Vec3>& vertices_;
  const std::vector<Triangle>& triangles_;
  const std::vector<std::array<std::uint32_t, 3>>& neighbours_;
  ParityPatch patch_;
  FaceView view_;
  Window<3> window_;                    ///< T'
  double centre_x_ = 0, centre_y_ = 0;  ///< of it
  double height_limit_ = 0, rim_ = 0;
};

}  // namespace meshbound
