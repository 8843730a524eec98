// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "verify/certificate_reader.h"
#include "verify/near_triangle.h"
#include "verify/numbers.h"

namespace meshbound::verify {

/// A convex part of a source triangle: the hull of these corners, in cyclic order, as indices into `PieceCorners`.
using Piece = std::vector<std::uint32_t>;

/// The corners of the pieces of one triangle. Each new one lies on a segment between two earlier ones at a share of
/// the way that is a fraction of a power of two, so every corner is an exact rational; it is held as an interval, and
/// worked out exactly only where somebody asks.
class PieceCorners {
 public:
  /// Forgets everything; the whole triangle is the piece {0, 1, 2}.
  void start(const Corners& triangle);

  [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(corners_.size()); }
  /// Forgets the corners from `size` on.
  void shrink(std::uint32_t size) { corners_.resize(size); }

  [[nodiscard]] const Vec<Interval>& rough(std::uint32_t i) const { return corners_[i].rough; }
  /// From the first corner of the triangle: far from the origin as narrow as the triangle asks.
  [[nodiscard]] const Vec<Interval>& way(std::uint32_t i) const { return corners_[i].way; }
  [[nodiscard]] const Vec<Exact>& exact(std::uint32_t i);
  /// The double coordinates, where the corner is one of the triangle itself.
  [[nodiscard]] const Eigen::Vector3d* given(std::uint32_t i) const { return i < 3 ? &triangle_[i] : nullptr; }

  /// Cuts a piece along a chord. The two pieces share the chord and together are the piece, whatever its shape: the
  /// corners of a piece are the image, under the affine map from a standard triangle, of a convex polygon there, and a
  /// chord between two points of the outline of a convex polygon makes two of it. Throws `Rejected` when an end of the
  /// chord lies on an edge that the piece does not have, or a piece would have more than `max_corners`.
  [[nodiscard]] std::pair<Piece, Piece> cut(const Piece& piece, const Token& chord);

 private:
  struct Corner {
    Vec<Interval> rough, way;
    std::uint32_t from = 0, to = 0;  ///< of the segment it lies on
    std::uint64_t numerator = 0;
    int bits = 0;
    std::optional<Vec<Exact>> exact;
  };
  [[nodiscard]] std::uint32_t point_on(const Piece& piece, const Token::End& end, int bits);

  Corners triangle_;
  std::vector<Corner> corners_;
};

}  // namespace meshbound::verify
