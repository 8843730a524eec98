// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "penetration/curves.h"
#include "penetration/placed_pair.h"

namespace meshbound {

/// A corner of a triangle (index of a vertex), a node of the curves, or a corner of what two triangles in one plane
/// have in common (flush.h).
struct PieceCorner {
  enum class Kind : std::uint32_t { Vertex, Node, Flush };
  Kind kind = Kind::Vertex;
  std::uint32_t index = 0;

  friend bool operator==(const PieceCorner&, const PieceCorner&) = default;
};

/// Local position of a corner on a triangle of `side`, how far that may be from the corner, and the exact position.
[[nodiscard]] const Vec3& position_of(PlacedPair& pair, const CrossingCurves& curves, std::uint32_t side,
                                      PieceCorner corner);
[[nodiscard]] double error_of(const PlacedPair& pair, const CrossingCurves& curves, std::uint32_t side,
                              PieceCorner corner);
[[nodiscard]] ExactNode exact_position_of(PlacedPair& pair, const CrossingCurves& curves, std::uint32_t side,
                                          PieceCorner corner);

/// The plane of a triangle, for the corners of its pieces: seen along an axis that the plane does not hold, so that the
/// triangle turns counter-clockwise.
class PiecePlane {
 public:
  PiecePlane(PlacedPair& pair, const CrossingCurves& curves, std::uint32_t side, std::uint32_t triangle);

  [[nodiscard]] const Vec3& position(PieceCorner corner) const { return position_of(*pair_, *curves_, side_, corner); }
  [[nodiscard]] double error(PieceCorner corner) const { return error_of(*pair_, *curves_, side_, corner); }

  /// Sign of the turn at q on the way from p to r, for the exact positions, without perturbation.
  [[nodiscard]] int turn(PieceCorner p, PieceCorner q, PieceCorner r) const;
  /// Twice the area on the left of a cycle as it is seen, rounded; and the exact sign of that area.
  [[nodiscard]] double area(std::span<const PieceCorner> cycle) const;
  [[nodiscard]] int area_sign(std::span<const PieceCorner> cycle) const;
  /// Whether a cycle is around another one, neither of which crosses the other.
  [[nodiscard]] bool is_around(std::span<const PieceCorner> outer, std::span<const PieceCorner> inner) const;
  /// The coordinates that are seen as x and y, 0 to 2.
  [[nodiscard]] std::array<int, 2> axes() const { return {first_, second_}; }

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
