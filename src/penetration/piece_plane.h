// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "penetration/curves.h"
#include "penetration/placed_pair.h"

namespace meshbound {

/// A corner of a triangle (index of a vertex) or a node of the curves.
struct PieceCorner {
  bool is_node = false;
  std::uint32_t index = 0;

  friend bool operator==(const PieceCorner&, const PieceCorner&) = default;
};

/// The plane of a triangle, for the corners of its pieces: seen along an axis that the plane does not hold, so that the
/// triangle turns counter-clockwise.
class PiecePlane {
 public:
  PiecePlane(PlacedPair& pair, const CrossingCurves& curves, std::uint32_t side, std::uint32_t triangle);

  [[nodiscard]] const Vec3& position(PieceCorner corner) const;
  /// How far `position` may be from the corner, as a length; local.
  [[nodiscard]] double error(PieceCorner corner) const;

  /// Sign of the turn at q on the way from p to r, for the exact positions, without perturbation.
  [[nodiscard]] int turn(PieceCorner p, PieceCorner q, PieceCorner r) const;
  /// Twice the area on the left of a cycle as it is seen, rounded; and the exact sign of that area.
  [[nodiscard]] double area(std::span<const PieceCorner> cycle) const;
  [[nodiscard]] int area_sign(std::span<const PieceCorner> cycle) const;
  /// Whether a cycle is around another one, neither of which crosses the other.
  [[nodiscard]] bool is_around(std::span<const PieceCorner> outer, std::span<const PieceCorner> inner) const;

  /// Coordinates as they are seen.
  [[nodiscard]] double x(PieceCorner corner) const;
  [[nodiscard]] double y(PieceCorner corner) const;

 private:
  struct Flat {
    mpz_class x, y, w;
  };
  [[nodiscard]] Flat exact(PieceCorner corner) const;

  PlacedPair* pair_;
  const CrossingCurves* curves_;
  std::uint32_t side_;
  int first_ = 0, second_ = 1;  ///< axes that are seen as x and y
};

}  // namespace meshbound
