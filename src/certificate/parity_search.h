// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "bvh/bvh_data.h"
#include "geometry/triangle_corners.h"
#include "proof/goal.h"
#include "proof/parity_patch.h"
#include "proof/piece.h"

namespace meshbound {

/// Tells in floating point, with room to spare, whether a reader will find a piece proven by parity
/// (tools/schema/certificate-1.md, proof/parity_patch.h): the patch P, grown from a seed, has nothing too high over the
/// piece, no edge with one triangle across it, and an odd number of triangles over one point of the piece. Whatever
/// comes near a limit counts as a failure, so that the reader's exact decisions are the same. Not thread-safe.
class ParitySearch {
 public:
  /// `goal` gives the tolerance and the slack, in B's working frame; `magnitude` bounds all coordinates there.
  /// `neighbours`: `edge_neighbours` of `target`; both must outlive this. O(n).
  ParitySearch(const Bvh::Data& target, const std::vector<std::array<std::uint32_t, 3>>& neighbours, const Goal& goal,
               double magnitude, std::size_t patch_limit);

  /// For a piece of `triangle`, with the triangle of B at `seed`, all in B's working frame. O(size of the patch).
  [[nodiscard]] bool proves(const TriangleCorners& triangle, const Piece& piece, std::uint32_t seed);

  /// Whether `proves` gave up last because the patch grew too large: parts of the piece may do.
  [[nodiscard]] bool patch_was_too_large() const { return patch_.is_full(); }

  /// What the patches that proved a piece cost a reader, as the format counts it, without decisions by rationals.
  [[nodiscard]] std::uint64_t work() const { return work_; }

  /// Half of what a reader must accept.
  static constexpr std::size_t max_patch = 32768;

 private:
  static constexpr std::uint64_t work_of_side = 4;  ///< of a triangle of a patch, for each corner of the piece

  struct Sight;
  [[nodiscard]] bool set_view(const TriangleCorners& triangle, const Piece& piece);
  [[nodiscard]] bool set_window(const Piece& piece);
  [[nodiscard]] bool is_clear(const Projected& p, const Projected& q, double margin) const;

  const Bvh::Data& b_;
  const std::vector<std::array<std::uint32_t, 3>>& neighbours_;
  double tolerance_ = 0, slack_ = 0, magnitude_ = 1;

  FaceView view_;
  double rim_ = 0, tilt_ = 0, height_limit_ = 0;
  Window<Piece::capacity> window_;  ///< the piece, drawn in
  ParityPatch patch_;
  std::uint64_t work_ = 0;
};

}  // namespace meshbound
