// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "geometry/triangle_corners.h"
#include "meshbound/triangle_mesh.h"
#include "simplify/cover/candidate_faces.h"

namespace meshbound {

/// Finds covers of original triangles by candidate faces: the forward half of a proof.
///
/// A piece is covered when the masks of its three corners share a bit: that face is within the tolerance of the corners
/// and, the distance to a triangle being convex, of the whole piece. Otherwise the piece is cut in two where it leaves
/// the faces that hold its ends. The cover fails at once when no candidate holds a corner: then the original has a
/// point there that is too far from all of them.
///
/// Cut points are rounded, so the two parts meet in a point beside the piece; the displacement, `cut_error` for each
/// cut on the way down, is part of the rounding slack of the proof (`deepest_cut`).
class ForwardCover {
 public:
  static constexpr int deepest_cut = 64;  ///< cuts on the way down to a piece
  /// Cuts spent on one triangle. Large ones that ten faces cover need a hundred; a quarter of this gives 2% more faces
  /// where triangles are 30 tolerances long.
  static constexpr int max_cuts = 256;
  /// Triangles that need more cuts than these are better tried by patches first (`PatchCover`).
  static constexpr int few_cuts = 32;

  ForwardCover(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles);

  /// Begins a new set of candidates; masks of earlier ones are forgotten.
  void begin(double tolerance);
  /// Adds a candidate. There are 64 at most; further ones are left out.
  void add(const TriangleCorners& corners, std::uint32_t face);
  [[nodiscard]] int size() const { return candidates_.size(); }
  [[nodiscard]] std::uint32_t face(int k) const { return faces_[static_cast<std::size_t>(k)]; }
  /// Candidates [0, size).
  [[nodiscard]] static FaceMask first(int size) {
    return size == CandidateFaces::capacity ? ~FaceMask{0} : (FaceMask{1} << size) - 1;
  }

  /// Mask of the candidates used when the triangle is covered by those of `allowed`, 0 when it is not.
  [[nodiscard]] FaceMask cover(std::uint32_t triangle, FaceMask allowed);
  /// As `cover`, by a single candidate, without cutting the triangle. The one that has covered the last triangle is
  /// tried before all others: triangles that follow one another lie near each other.
  [[nodiscard]] FaceMask cover_whole(std::uint32_t triangle, FaceMask allowed);
  /// A single candidate that holds all these vertices, and so whatever triangles they are the corners of; 0 if there is
  /// none. The one that has covered the last triangle is tried before all others.
  [[nodiscard]] FaceMask hold_all(std::span<const std::uint32_t> vertices, FaceMask allowed);
  /// As `cover`, where nothing is known: of the candidates that hold the triangle the one nearest to its middle, or
  /// few pieces, for which small candidates are tried as well.
  [[nodiscard]] FaceMask cover_thoroughly(std::uint32_t triangle, FaceMask allowed);
  /// Mask of the candidates that together cover a sub-triangle, 0 when they do not. None if no candidate holds
  /// some corner. `depth`: cuts that made the sub-triangle.
  [[nodiscard]] std::optional<FaceMask> cover_sub_triangle(const TriangleCorners& corners, int depth);
  /// Whether some candidate of `allowed` is within the tolerance of each corner.
  [[nodiscard]] bool are_corners_near(std::uint32_t triangle, FaceMask allowed);
  /// The candidates of `allowed` that are within the tolerance of a vertex.
  [[nodiscard]] FaceMask holding(std::uint32_t vertex, FaceMask allowed);
  /// The point that no candidate held where the last cover failed; absent where it failed for another reason.
  [[nodiscard]] const std::optional<Vec3>& lost_point() const { return lost_point_; }

 private:
  struct Piece {
    TriangleCorners corners;
    std::array<FaceMask, 3> masks;
    int depth = 0;  ///< cuts that made it
  };
  enum class Asked { LikelyOnes, All };  ///< whether a point of a cut is near candidates that hold no corner, too
  [[nodiscard]] FaceMask cover_in_pieces(std::uint32_t triangle, FaceMask allowed, int cuts);
  [[nodiscard]] FaceMask cover_in_pieces(const Piece& whole, FaceMask allowed, Asked asked, int cuts);
  [[nodiscard]] bool cut(const Piece& piece, FaceMask allowed, Asked asked);

  struct CachedMask {
    std::uint32_t round = 0, vertex = 0;
    FaceMask known = 0;  ///< candidates that have been asked
    FaceMask mask = 0;
  };

  const std::vector<Vec3>& vertices_;
  const std::vector<Triangle>& triangles_;
  CandidateFaces candidates_;
  std::array<std::uint32_t, CandidateFaces::capacity> faces_{};
  double shortest_squared_edge_ = 0;
  FaceMask last_ = 0;  ///< the candidate that has covered a triangle last
  std::uint32_t round_ = 0;
  std::vector<CachedMask> cache_;  ///< by vertex, modulo their count
  std::vector<Piece> open_;
  std::optional<Vec3> lost_point_;
};

}  // namespace meshbound
