// SPDX-License-Identifier: MIT
/// Convex pieces of a triangle of A and their cuts. Compiled once per instruction set (numeric/isa.h).
#pragma once
#include <algorithm>
#include <cstdint>

#include "bvh/bvh_data.h"
#include "geometry/point_triangle.h"
#include "numeric/simd.h"

namespace meshbound {
inline namespace MESHBOUND_ISA {

/// What the walk knows of a piece, and how it came to be.
struct alignas(32) PieceState {
  std::uint32_t count = 0;        ///< number of corners
  std::uint32_t slot = 0;         ///< candidate triangle of B
  std::uint32_t rival = no_slot;  ///< the triangle that serves what the last split cut off from this piece
  std::uint32_t depth = 0;        ///< cuts that led here
  std::uint32_t rounds = 0;       ///< queries that led here since the last halving
  std::uint32_t splits = 0;       ///< between a candidate and another triangle that led here since the last halving
  std::uint32_t age = 0;          ///< steps walked since a query chose or confirmed a candidate
  bool trimmed = false;           ///< lies inside the pushed-out cell of its candidate, so only the cell itself cuts it
  bool in_cell = false;           ///< lies inside that cell itself
};

/// A convex polygon in the plane of a triangle of A, up to the rounding of its cuts, with the triangle of B that is
/// tried for it. Corners are stored lane by lane; unused lanes up to the next multiple of four repeat the last corner.
struct Piece : PieceState {
  static constexpr std::uint32_t capacity = 12;
  /// A cut of a piece of up to so many corners always fits: k corners on one side have at most 2 min(k, count - k)
  /// crossings around them, k + 2 min(k, 8 - k) <= 12.
  static constexpr std::uint32_t crowded = 8;
  alignas(32) double x[capacity], y[capacity], z[capacity];

  Piece() {}  // NOLINT: corners beyond `count` stay as they are, pieces are made by the million
  Piece(const Piece& other) { *this = other; }
  /// Copies only the lanes in use: most pieces have three or four corners.
  Piece& operator=(const Piece& other) {
    PieceState::operator=(other);
    for (std::uint32_t first = 0; first < count; first += 4) {
      *reinterpret_cast<Double4*>(x + first) = *reinterpret_cast<const Double4*>(other.x + first);
      *reinterpret_cast<Double4*>(y + first) = *reinterpret_cast<const Double4*>(other.y + first);
      *reinterpret_cast<Double4*>(z + first) = *reinterpret_cast<const Double4*>(other.z + first);
    }
    return *this;
  }

  [[nodiscard]] Vec3 corner(std::uint32_t i) const { return {x[i], y[i], z[i]}; }

  void add(const Vec3& p) {
    x[count] = p.x;
    y[count] = p.y;
    z[count] = p.z;
    ++count;
  }

  void pad() {
    for (std::uint32_t i = count; i % 4 != 0; ++i) {
      x[i] = x[count - 1];
      y[i] = y[count - 1];
      z[i] = z[count - 1];
    }
  }
};

inline Piece whole_triangle(const Vec3& a, const Vec3& b, const Vec3& c, std::uint32_t slot) {
  Piece piece;
  piece.slot = slot;
  piece.add(a);
  piece.add(b);
  piece.add(c);
  piece.pad();
  return piece;
}

inline Vec<Double4> corners4(const Piece& piece, std::uint32_t first) {
  return {*reinterpret_cast<const Double4*>(piece.x + first), *reinterpret_cast<const Double4*>(piece.y + first),
          *reinterpret_cast<const Double4*>(piece.z + first)};
}

inline CornerTriangle<Double4> broadcast4(const CornerTriangle<double>& t) {
  return {{broadcast4(t.a.x), broadcast4(t.a.y), broadcast4(t.a.z)},
          {broadcast4(t.ab.x), broadcast4(t.ab.y), broadcast4(t.ab.z)},
          {broadcast4(t.ac.x), broadcast4(t.ac.y), broadcast4(t.ac.z)}};
}

struct Farthest {
  double squared = 0;
  std::uint32_t corner = 0;
};

/// The corner furthest from a triangle. The distance to a convex set is convex, so no point of the piece is further.
inline Farthest farthest_corner(const Piece& piece, const CornerTriangle<double>& triangle) {
  const CornerTriangle<Double4> t = broadcast4(triangle);
  Farthest farthest{-1, 0};
  for (std::uint32_t first = 0; first < piece.count; first += 4) {
    const Double4 squared = closest_on_triangle(t, corners4(piece, first)).squared_distance;
    for (std::uint32_t lane = 0; lane < 4; ++lane)
      if (squared[lane] > farthest.squared) farthest = {squared[lane], first + lane};
  }
  return farthest;
}

/// The squared distance of the corner furthest from a triangle.
inline double largest_squared_distance(const Piece& piece, const CornerTriangle<double>& triangle) {
  const CornerTriangle<Double4> t = broadcast4(triangle);
  Double4 max{};
  for (std::uint32_t first = 0; first < piece.count; first += 4)
    max = maximum(max, closest_on_triangle(t, corners4(piece, first)).squared_distance);
  return horizontal_maximum(max);
}

/// A bound of the squared distances of all corners at half the cost of `farthest_corner`: the first of the points that
/// `closest_on_triangle` tries lies on the triangle, whether it is the closest or not.
[[gnu::always_inline]] inline double quick_bound(const Piece& piece, const CornerTriangle<double>& triangle) {
  const CornerTriangle<Double4> t = broadcast4(triangle);
  Double4 max{};
  for (std::uint32_t first = 0; first < piece.count; first += 4)
    max = maximum(max, squared_length(offset_from_inside(t, corners4(piece, first))));
  return horizontal_maximum(max);
}

/// Signed distances of the corners to the plane {x : normal . x = offset}, times the length of the normal.
struct CornerDistances {
  alignas(32) double value[Piece::capacity];
  double min = 0, max = 0;
};

inline CornerDistances distances_from_plane(const Piece& piece, const Vec3& normal, double offset) {
  CornerDistances sides;
  const Vec<Double4> n{broadcast4(normal.x), broadcast4(normal.y), broadcast4(normal.z)};
  Double4 min = broadcast4(std::numeric_limits<double>::infinity()), max = -min;
  for (std::uint32_t first = 0; first < piece.count; first += 4) {
    const Double4 value = dot(n, corners4(piece, first)) - broadcast4(offset);
    *reinterpret_cast<Double4*>(sides.value + first) = value;
    min = minimum(min, value);  // lanes beyond the count repeat a corner
    max = maximum(max, value);
  }
  sides.min = -horizontal_maximum(-min);
  sides.max = horizontal_maximum(max);
  return sides;
}

/// Whether both parts of a cut have room for their corners.
inline bool parts_fit(const Piece& piece, const CornerDistances& sides) {
  std::uint32_t inside = 0, outside = 0;
  for (std::uint32_t i = 0; i < piece.count; ++i) {
    const double s = sides.value[i], e = sides.value[i + 1 == piece.count ? 0 : i + 1];
    const bool crossed = (s < 0 && e > 0) || (s > 0 && e < 0);
    inside += static_cast<std::uint32_t>(s <= 0) + static_cast<std::uint32_t>(crossed);
    outside += static_cast<std::uint32_t>(s >= 0) + static_cast<std::uint32_t>(crossed);
  }
  return inside <= Piece::capacity && outside <= Piece::capacity;
}

/// Cuts a piece in two along edges whose ends lie on different sides; both parts share each new corner. The parts cover
/// the piece whatever the signs are: new corners lie on the piece's edges, what they cut off is a run of corners of one
/// side, and the hull of the new corners belongs to both. False, and nothing cut, when a part would not fit in
/// `capacity`.
inline bool cut(const Piece& piece, const CornerDistances& sides, Piece& inside, Piece& outside) {
  if (piece.count > Piece::crowded && !parts_fit(piece, sides)) return false;
  inside.count = outside.count = 0;
  for (std::uint32_t i = 0; i < piece.count; ++i) {
    const std::uint32_t j = i + 1 == piece.count ? 0 : i + 1;
    const double s = sides.value[i], e = sides.value[j];
    const Vec3 from = piece.corner(i);
    if (s <= 0) inside.add(from);
    if (s >= 0) outside.add(from);
    if ((s < 0 && e > 0) || (s > 0 && e < 0)) {
      const Vec3 point = from + (s / (s - e)) * (piece.corner(j) - from);
      inside.add(point);
      outside.add(point);
    }
  }
  for (Piece* part : {&inside, &outside}) {
    part->depth = piece.depth + 1;
    part->rounds = piece.rounds;
    part->splits = piece.splits;
    if (part->count > 0) part->pad();
  }
  return true;
}

/// The point `share` of the way along the edge from corner `edge` to the next.
struct BoundaryPoint {
  std::uint32_t edge;
  double share;  ///< 0 <= share <= 1
};

/// Cuts a piece in two by the chord between points on two different edges; both parts share the new corners. The
/// corners after `from` up to `to` are those of `first`. False, and nothing cut, when a part would not fit in
/// `capacity`.
inline bool cut_by_chord(const Piece& piece, const BoundaryPoint& from, const BoundaryPoint& to, Piece& first,
                         Piece& second) {
  const auto next = [&](std::uint32_t i) { return i + 1 == piece.count ? 0 : i + 1; };
  const std::uint32_t in_first = (to.edge + piece.count - from.edge) % piece.count;
  if (std::max(in_first, piece.count - in_first) + 2 > Piece::capacity) return false;
  const auto at = [&](const BoundaryPoint& p) {
    return piece.corner(p.edge) + p.share * (piece.corner(next(p.edge)) - piece.corner(p.edge));
  };
  const auto fill = [&](Piece& part, const BoundaryPoint& begin, const BoundaryPoint& end) {
    part.count = 0;
    part.depth = piece.depth + 1;
    part.rounds = piece.rounds;
    part.splits = piece.splits;
    part.add(at(begin));
    for (std::uint32_t i = next(begin.edge);; i = next(i)) {
      part.add(piece.corner(i));
      if (i == end.edge) break;
    }
    part.add(at(end));
    part.pad();
  };
  fill(first, from, to);
  fill(second, to, from);
  return true;
}

/// Splits a piece of at least four corners along the shortest diagonal that leaves half of the corners on each side.
/// No corner is computed, so nothing is rounded.
inline void split_by_diagonal(const Piece& piece, Piece& first, Piece& second) {
  const std::uint32_t half = piece.count / 2;
  std::uint32_t from = 0;
  double shortest = std::numeric_limits<double>::infinity();
  for (std::uint32_t i = 0; i < half; ++i) {
    const double squared = squared_length(piece.corner(i + half) - piece.corner(i));
    if (squared < shortest) {
      shortest = squared;
      from = i;
    }
  }
  first = second = piece;
  first.count = second.count = 0;
  for (std::uint32_t i = 0; i <= half; ++i) first.add(piece.corner(from + i));
  for (std::uint32_t i = half; i <= piece.count; ++i) second.add(piece.corner((from + i) % piece.count));
  first.pad();
  second.pad();
}

}  // namespace MESHBOUND_ISA
}  // namespace meshbound
