// SPDX-License-Identifier: MIT
/// Convex pieces of a triangle of A and their cuts. Compiled once per instruction set (numeric/isa.h).
#pragma once
#include <cstdint>

#include "geometry/point_triangle.h"
#include "numeric/simd.h"

namespace meshbound {
inline namespace MESHBOUND_ISA {

/// A convex polygon in the plane of a triangle of A, up to the rounding of its cuts, with the triangle of B that is
/// tried for it. Corners are stored lane by lane; unused lanes up to the next multiple of four repeat the last corner.
struct alignas(32) Piece {
  static constexpr std::uint32_t capacity = 12;
  std::uint32_t count = 0;
  std::uint32_t slot = 0;    ///< candidate triangle of B
  std::uint32_t depth = 0;   ///< cuts that led here
  std::uint32_t rounds = 0;  ///< queries that led here
  std::uint32_t age = 0;     ///< steps walked since a query chose or confirmed a candidate
  bool trimmed = false;      ///< lies inside the pushed-out cell of its candidate, so only the cell itself cuts it
  alignas(32) double x[capacity], y[capacity], z[capacity];

  Piece() {}  // NOLINT: corners beyond `count` stay as they are, pieces are made by the million
  Piece(const Piece& other) { *this = other; }
  /// Copies only the lanes in use: most pieces have three or four corners.
  Piece& operator=(const Piece& other) {
    count = other.count;
    slot = other.slot;
    depth = other.depth;
    rounds = other.rounds;
    age = other.age;
    trimmed = other.trimmed;
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

/// As `farthest_corner`, without saying which.
inline double largest_squared_distance(const Piece& piece, const CornerTriangle<double>& triangle) {
  const CornerTriangle<Double4> t = broadcast4(triangle);
  Double4 most{};
  for (std::uint32_t first = 0; first < piece.count; first += 4)
    most = maximum(most, closest_on_triangle(t, corners4(piece, first)).squared_distance);
  return horizontal_maximum(most);
}

/// A bound of the squared distances of all corners at half the cost of `farthest_corner`: the first of the points that
/// `closest_on_triangle` tries lies on the triangle, whether it is the closest or not.
inline double quick_bound(const Piece& piece, const CornerTriangle<double>& triangle) {
  const CornerTriangle<Double4> t = broadcast4(triangle);
  Double4 most{};
  for (std::uint32_t first = 0; first < piece.count; first += 4)
    most = maximum(most, squared_length(offset_from_inside(t, corners4(piece, first))));
  return horizontal_maximum(most);
}

/// Signed distances of the corners to the plane {x : normal . x = offset}, times the length of the normal.
struct PlaneSides {
  alignas(32) double value[Piece::capacity];
  double least = 0, most = 0;
};

inline PlaneSides sides_of(const Piece& piece, const Vec3& normal, double offset) {
  PlaneSides sides;
  const Vec<Double4> n{broadcast4(normal.x), broadcast4(normal.y), broadcast4(normal.z)};
  Double4 least = broadcast4(std::numeric_limits<double>::infinity()), most = -least;
  for (std::uint32_t first = 0; first < piece.count; first += 4) {
    const Double4 value = dot(n, corners4(piece, first)) - broadcast4(offset);
    *reinterpret_cast<Double4*>(sides.value + first) = value;
    least = minimum(least, value);  // lanes beyond the count repeat a corner
    most = maximum(most, value);
  }
  sides.least = -horizontal_maximum(-least);
  sides.most = horizontal_maximum(most);
  return sides;
}

/// Cuts a piece in two along edges whose ends lie on different sides; both parts share each new corner. The parts cover
/// the piece whatever the signs are: new corners lie on the piece's edges, what they cut off is a run of corners of one
/// side, and the hull of the new corners belongs to both. False, and nothing cut, when a part would not fit in
/// `capacity`.
inline bool cut(const Piece& piece, const PlaneSides& sides, Piece& inside, Piece& outside) {
  inside.count = outside.count = 0;
  for (std::uint32_t i = 0; i < piece.count; ++i) {
    if (inside.count + 2 > Piece::capacity || outside.count + 2 > Piece::capacity) return false;
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
    if (part->count > 0) part->pad();
  }
  return true;
}

}  // namespace MESHBOUND_ISA
}  // namespace meshbound
