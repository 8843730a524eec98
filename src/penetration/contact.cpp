// SPDX-License-Identifier: MIT
#include "penetration/contact.h"

#include <algorithm>
#include <cmath>

#include "geometry/magnitude.h"
#include "geometry/unit.h"
#include "numeric/rounding.h"

namespace meshbound {
namespace {

/// Sign of the turn p, q, r seen along an axis; 0 where doubles cannot tell. A computed difference is off by at most h
/// = 2 `error` and a relative u, so each of the two products by at most h (|.| + |.| + h) and 3 u.
int certain_turn(const Vec3& p, const Vec3& q, const Vec3& r, int axis, double error) {
  const int i = (axis + 1) % 3, j = (axis + 2) % 3;
  const double ax = coordinate(q, i) - coordinate(p, i), ay = coordinate(q, j) - coordinate(p, j);
  const double bx = coordinate(r, i) - coordinate(p, i), by = coordinate(r, j) - coordinate(p, j);
  const double h = 2 * error, sum = std::fabs(ax) + std::fabs(ay) + std::fabs(bx) + std::fabs(by) + 4 * h;
  const double magnitude = std::fabs(ax * by) + std::fabs(ay * bx);
  const double bound = 8 * unit_roundoff * magnitude + 2 * h * sum + 0x1p-1000;
  const double turn = ax * by - ay * bx;
  if (turn > bound) return 1;
  return turn < -bound ? -1 : 0;
}

/// The axis along which the projection of a triangle is largest.
int dominant_axis(const Vec3& p, const Vec3& q, const Vec3& r) {
  const Vec3 n = cross(q - p, r - p);
  const double x = std::fabs(n.x), y = std::fabs(n.y), z = std::fabs(n.z);
  return x >= y ? (x >= z ? 0 : 2) : (y >= z ? 1 : 2);
}

/// Whether the line through an edge of s, seen along an axis, separates s from t and touches t at most in vertices that
/// both have. False also where doubles cannot tell.
bool an_edge_separates(PlacedPair& pair, const PairTriangle& s, const PairTriangle& t, int axis, double error) {
  for (std::size_t k = 0; k < 3; ++k) {
    const PairVertex from = s[k], to = s[next_corner(k)], apex = s[next_corner(next_corner(k))];
    const int own = certain_turn(pair.local(from), pair.local(to), pair.local(apex), axis, error);
    if (own == 0) return false;
    const bool separates = std::all_of(t.begin(), t.end(), [&](const PairVertex& v) {
      const bool shared = v.side == from.side && (v.vertex == from.vertex || v.vertex == to.vertex);
      return shared || certain_turn(pair.local(from), pair.local(to), pair.local(v), axis, error) == -own;
    });
    if (separates) return true;
  }
  return false;
}

bool are_separate(PlacedPair& pair, const PairTriangle& s, const PairTriangle& t) {
  const double error = pair.largest_error();
  const int axis = dominant_axis(pair.local(s[0]), pair.local(s[1]), pair.local(s[2]));
  return an_edge_separates(pair, s, t, axis, error) || an_edge_separates(pair, t, s, axis, error);
}

/// The direction in the middle of two.
Vec3 between(const Vec3& a, const Vec3& b) { return unit(unit(a) + unit(b)); }

/// Whether a plane through the common corner s[0] = t[0] has the other corners of s on one side and those of t on the
/// other. False also where doubles cannot tell. Around a vertex with n triangles it tells nearly all of the n^2 / 2
/// pairs apart.
bool are_apart_around_corner(PlacedPair& pair, const PairTriangle& s, const PairTriangle& t) {
  const Vec3 corner = pair.local(s[0]);
  const Vec3 s1 = pair.local(s[1]) - corner, s2 = pair.local(s[2]) - corner, t1 = pair.local(t[1]) - corner,
             t2 = pair.local(t[2]) - corner;
  const Vec3 normal = between(s1, s2) - between(t1, t2);
  // A component of a way is off by at most 2 `error` and a relative u, a product by 3u more.
  const auto height = [&](const Vec3& way) { return dot(normal, way); };
  const double size = std::fabs(normal.x) + std::fabs(normal.y) + std::fabs(normal.z);
  const auto bound = [&](const Vec3& way) {
    return size * (2 * pair.largest_error() + 4 * unit_roundoff * largest_magnitude_of(way)) + 0x1p-1000;
  };
  return height(s1) > bound(s1) && height(s2) > bound(s2) && height(t1) < -bound(t1) && height(t2) < -bound(t2);
}

int exact_turn(const ExactPoint& p, const ExactPoint& q, const ExactPoint& r, int axis) {
  const int i = (axis + 1) % 3, j = (axis + 2) % 3;
  const mpz_class turn = (coordinate(q, i) - coordinate(p, i)) * (coordinate(r, j) - coordinate(p, j)) -
                         (coordinate(q, j) - coordinate(p, j)) * (coordinate(r, i) - coordinate(p, i));
  return sgn(turn);
}

/// Whether a segment and a triangle of one plane meet, seen along an axis that is not parallel to the plane.
bool flat_segment_meets(const ExactPoint& p, const ExactPoint& q, const std::array<const ExactPoint*, 3>& t, int axis) {
  // The two are disjoint if one of four lines separates them: that of the segment or that of an edge of the triangle.
  const int own = exact_turn(*t[0], *t[1], *t[2], axis);
  for (std::size_t k = 0; k < 3; ++k) {
    const ExactPoint &from = *t[k], &to = *t[next_corner(k)];
    if (exact_turn(from, to, p, axis) == -own && exact_turn(from, to, q, axis) == -own) return false;
  }
  const int a = exact_turn(p, q, *t[0], axis), b = exact_turn(p, q, *t[1], axis), c = exact_turn(p, q, *t[2], axis);
  return !((a > 0 && b > 0 && c > 0) || (a < 0 && b < 0 && c < 0));
}

bool segment_meets(PlacedPair& pair, PairVertex p, PairVertex q, const PairTriangle& t) {
  const int at_p = pair.orientation(t[0], t[1], t[2], p), at_q = pair.orientation(t[0], t[1], t[2], q);
  if (at_p != 0 && at_p == at_q) return false;
  if (at_p == 0 && at_q == 0) {
    const ExactPoint &a = pair.exact(t[0]), &b = pair.exact(t[1]), &c = pair.exact(t[2]);
    const ExactPoint normal = cross(b - a, c - a);
    const int axis = sgn(normal.x) != 0 ? 0 : (sgn(normal.y) != 0 ? 1 : 2);
    return flat_segment_meets(pair.exact(p), pair.exact(q), {&a, &b, &c}, axis);
  }
  int least = 1, largest = -1;
  for (std::size_t k = 0; k < 3; ++k) {
    const int turn = pair.orientation(p, q, t[k], t[next_corner(k)]);
    least = std::min(least, turn);
    largest = std::max(largest, turn);
  }
  return least >= 0 || largest <= 0;
}

/// `PlacedPair::orientation`, or `certain_orientation` where doubles alone are asked.
using Orientation = int (PlacedPair::*)(PairVertex, PairVertex, PairVertex, PairVertex);

/// Whether all corners of s lie strictly on one side of the plane of t.
bool plane_separates(PlacedPair& pair, const PairTriangle& s, const PairTriangle& t, Orientation orientation) {
  const auto side_of = [&](PairVertex v) { return (pair.*orientation)(t[0], t[1], t[2], v); };
  const int first = side_of(s[0]);
  return first != 0 && side_of(s[1]) == first && side_of(s[2]) == first;
}

/// Whether the plane of one of two triangles has all corners of the other strictly on one side.
bool a_plane_separates(PlacedPair& pair, const PairTriangle& s, const PairTriangle& t, Orientation orientation) {
  return plane_separates(pair, s, t, orientation) || plane_separates(pair, t, s, orientation);
}

/// Moves the corners that s shares with t to the front, in their order, and returns their number.
std::size_t shared_first(Triangle& s, const Triangle& t) {
  std::size_t shared = 0;
  for (std::size_t k = 0; k < 3; ++k)
    if (std::find(t.begin(), t.end(), s[k]) != t.end())
      std::rotate(s.begin() + shared++, s.begin() + k, s.begin() + k + 1);
  return shared;
}

/// Whether triangles with a common edge (a, b) also meet elsewhere: they do if both lie in one plane, on the same side
/// of the edge.
bool folded(PlacedPair& pair, PairVertex a, PairVertex b, PairVertex c, PairVertex d) {
  if (pair.orientation(a, b, c, d) != 0) return false;
  const ExactPoint &p = pair.exact(a), &q = pair.exact(b), &r = pair.exact(c), &s = pair.exact(d);
  const ExactPoint normal = cross(q - p, r - p);
  const int axis = sgn(normal.x) != 0 ? 0 : (sgn(normal.y) != 0 ? 1 : 2);
  return exact_turn(p, q, r, axis) == exact_turn(p, q, s, axis);
}

}  // namespace

bool triangles_meet(PlacedPair& pair, const PairTriangle& s, const PairTriangle& t) {
  if (a_plane_separates(pair, s, t, &PlacedPair::orientation)) return false;
  for (std::size_t k = 0; k < 3; ++k)
    if (segment_meets(pair, s[k], s[next_corner(k)], t) || segment_meets(pair, t[k], t[next_corner(k)], s)) return true;
  return false;
}

bool triangles_cross(PlacedPair& pair, const Triangle& s, const Triangle& t) {
  Triangle first = s, second = t;
  const std::size_t shared = shared_first(first, second);
  shared_first(second, first);
  if (shared >= 2 && first[0] != second[0]) std::swap(second[0], second[1]);
  if (shared == 3) return true;
  const auto vertices = [](const Triangle& u) { return PairTriangle{{{0, u[0]}, {0, u[1]}, {0, u[2]}}}; };
  const PairTriangle p = vertices(first), q = vertices(second);
  if (shared == 0 && a_plane_separates(pair, p, q, &PlacedPair::certain_orientation)) return false;
  if (shared == 1 && are_apart_around_corner(pair, p, q)) return false;
  if (are_separate(pair, p, q)) return false;
  if (shared == 2) return folded(pair, p[0], p[1], p[2], q[2]);
  // Whatever two triangles with a common corner have in common besides continues to the edge opposite to that corner in
  // one of them.
  if (shared == 1) return segment_meets(pair, p[1], p[2], q) || segment_meets(pair, q[1], q[2], p);
  return triangles_meet(pair, p, q);
}

}  // namespace meshbound
