// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "simplify/candidate_faces.h"

namespace meshbound {

/// Finds covers of original triangles by candidate faces: the forward half of the tracker.
///
/// A piece is covered when the masks of its three corners share a bit: that face is within the tolerance of the corners
/// and, the distance to a triangle being convex, of the whole piece. Otherwise the piece is cut in two where it leaves
/// the faces that hold its ends. The cover fails at once when no candidate holds a corner: then the original has a
/// point there that is too far from all of them.
///
/// Cut points are rounded, so the two parts meet in a point beside the piece; the displacement, `cut_error` for each
/// cut on the way down, is part of the rounding slack of the tracker (`deepest_cut`).
class ForwardCover {
 public:
  static constexpr int deepest_cut = 64;  ///< cuts spent on one original triangle

  ForwardCover(const std::vector<Vec3>& vertices, const std::vector<std::array<std::uint32_t, 3>>& triangles);

  /// Begins a new set of candidates; masks of earlier ones are forgotten.
  void begin(double tolerance);
  /// False when there is no room for more.
  bool add(const std::array<Vec3, 3>& corners, std::uint32_t face);
  /// Candidates so far are the added faces, later ones the ring.
  void close_added() { added_ = candidates_.size(); }
  [[nodiscard]] int added() const { return added_; }
  [[nodiscard]] int size() const { return candidates_.size(); }
  [[nodiscard]] std::uint32_t face(int k) const { return faces_[static_cast<std::size_t>(k)]; }

  /// Mask of the candidates used when the triangle is covered by the added faces alone (`with_ring` false) or by all,
  /// 0 when it is not. `preferred` are tried first.
  [[nodiscard]] FaceMask cover(std::uint32_t triangle, bool with_ring, FaceMask preferred);

  /// True when no candidate, ring included, holds some corner of the triangle.
  [[nodiscard]] bool corner_out_of_reach(std::uint32_t triangle);

  std::uint64_t splits = 0, cuts = 0;

 private:
  struct Piece {
    std::array<Vec3, 3> corners;
    std::array<FaceMask, 3> masks;
  };
  [[nodiscard]] FaceMask mask_of(std::uint32_t vertex, bool with_ring);
  [[nodiscard]] FaceMask mask_at(Vec3 p, bool with_ring) const {
    return candidates_.holding(p, 0, with_ring ? candidates_.size() : added_);
  }
  [[nodiscard]] FaceMask cover_in_pieces(const Piece& whole, bool with_ring);
  [[nodiscard]] bool cut(const Piece& piece, bool with_ring);

  struct CachedMask {
    std::uint32_t round = 0;
    std::uint8_t known = 0;  ///< candidates [0, known) are in `mask`
    FaceMask mask = 0;
  };

  const std::vector<Vec3>& vertices_;
  const std::vector<std::array<std::uint32_t, 3>>& triangles_;
  CandidateFaces candidates_;
  std::array<std::uint32_t, CandidateFaces::capacity> faces_{};
  int added_ = 0;
  double shortest_squared_edge_ = 0;
  std::uint32_t round_ = 0;
  std::vector<CachedMask> cache_;
  std::vector<Piece> open_;
};

}  // namespace meshbound
