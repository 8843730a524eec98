// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "numeric/rounding.h"
#include "penetration/curves.h"
#include "penetration/placed_pair.h"

namespace meshbound {

/// A corner of a piece: a vertex of the model by its index, a node of the curves, or a corner of the intersection of
/// two triangles of one plane (flush.h).
struct PieceCorner {
  enum class Kind : std::uint32_t { Vertex, Node, Flush };
  Kind kind = Kind::Vertex;
  std::uint32_t index = 0;

  friend bool operator==(const PieceCorner&, const PieceCorner&) = default;
};

using CornerTriple = std::array<PieceCorner, 3>;

/// Local position of a corner on a triangle of `side`; the largest distance of that from the corner; the exact
/// position.
[[nodiscard]] const Vec3& position_of(PlacedPair& pair, const CrossingCurves& curves, std::uint32_t side,
                                      PieceCorner corner);
[[nodiscard]] double error_of(const PlacedPair& pair, const CrossingCurves& curves, std::uint32_t side,
                              PieceCorner corner);
[[nodiscard]] ExactNode exact_position_of(PlacedPair& pair, const CrossingCurves& curves, std::uint32_t side,
                                          PieceCorner corner);

/// Sign of the determinant ax * by - ay * bx of differences that are off by at most `h` each; 0 where that or rounding
/// could hide it.
[[nodiscard]] inline int turn_beyond_error(double ax, double ay, double bx, double by, double h) {
  const double magnitude = std::fabs(ax * by) + std::fabs(ay * bx);
  const double sum = std::fabs(ax) + std::fabs(ay) + std::fabs(bx) + std::fabs(by) + 4 * h;
  const double bound = 8 * unit_roundoff * magnitude + 2 * h * sum + 0x1p-1000;
  const double value = ax * by - ay * bx;
  if (value > bound) return 1;
  return value < -bound ? -1 : 0;
}

/// The plane of a triangle, for the corners of its pieces: projected along an axis that is not parallel to the plane,
/// so that the triangle turns counter-clockwise.
class PiecePlane {
 public:
  PiecePlane(PlacedPair& pair, const CrossingCurves& curves, std::uint32_t side, std::uint32_t triangle);

  [[nodiscard]] const Vec3& position(PieceCorner corner) const { return position_of(*pair_, *curves_, side_, corner); }
  [[nodiscard]] double error(PieceCorner corner) const { return error_of(*pair_, *curves_, side_, corner); }

  /// A corner as the projection shows it.
  struct Seen {
    PieceCorner corner;
    double x, y, error;
  };
  [[nodiscard]] Seen see(PieceCorner corner) const;

  /// `PlacedPair::count_steps`.
  void count_steps(std::uint64_t count) const { pair_->count_steps(count); }

  /// Sign of the turn at q on the way from p to r, for the exact positions, without perturbation.
  [[nodiscard]] int turn(const Seen& p, const Seen& q, const Seen& r) const {
    // As in `orientation`: the error of a difference.
    const double h = p.error + std::max(q.error, r.error);
    const int sign = turn_beyond_error(q.x - p.x, q.y - p.y, r.x - p.x, r.y - p.y, h);
    return sign != 0 ? sign : exact_turn(p.corner, q.corner, r.corner);
  }
  [[nodiscard]] int turn(PieceCorner p, PieceCorner q, PieceCorner r) const { return turn(see(p), see(q), see(r)); }
  /// Twice the area enclosed by a cycle in the projection, rounded; and the exact sign of the sum of those of cycles.
  [[nodiscard]] double area(std::span<const PieceCorner> cycle) const;
  [[nodiscard]] int area_sign(std::span<const std::span<const PieceCorner>> cycles) const;
  /// Whether the cycle `outer` is around `inner`; the two must not cross.
  [[nodiscard]] bool is_around(std::span<const PieceCorner> outer, std::span<const PieceCorner> inner) const;
  /// The coordinates that the projection shows as x and y, 0 to 2.
  [[nodiscard]] std::array<int, 2> axes() const { return {first_, second_}; }

  /// Coordinates in the projection.
  [[nodiscard]] double x(PieceCorner corner) const;
  [[nodiscard]] double y(PieceCorner corner) const;

 private:
  struct Flat {
    mpz_class x, y, w;
  };
  [[nodiscard]] Flat exact(PieceCorner corner) const;
  [[nodiscard]] int exact_turn(PieceCorner p, PieceCorner q, PieceCorner r) const;
  [[nodiscard]] bool are_in_line(PieceCorner p, PieceCorner q, PieceCorner r) const;
  [[nodiscard]] std::uint32_t edge_with(PieceCorner node) const;
  [[nodiscard]] bool is_on_edge(PieceCorner corner, std::uint32_t edge) const;
  [[nodiscard]] std::array<std::uint32_t, 2> planes_through(PieceCorner corner) const;

  PlacedPair* pair_;
  const CrossingCurves* curves_;
  std::uint32_t side_;
  int first_ = 0, second_ = 1;  ///< axes shown as x and y
};

}  // namespace meshbound
