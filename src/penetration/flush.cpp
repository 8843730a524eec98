// SPDX-License-Identifier: MIT
#include "penetration/flush.h"

#include <algorithm>
#include <unordered_map>

namespace meshbound {
namespace {

using ExactVector = std::array<mpq_class, 3>;

ExactVector to_vector(const ExactPoint& p) { return {p.x, p.y, p.z}; }

mpq_class turn(const ExactVector& p, const ExactVector& q, const ExactVector& r, const std::array<int, 2>& axes) {
  const auto i = static_cast<std::size_t>(axes[0]), j = static_cast<std::size_t>(axes[1]);
  return (q[i] - p[i]) * (r[j] - p[j]) - (q[j] - p[j]) * (r[i] - p[i]);
}

/// Cuts off what lies to the right of the line from `from` to `to`: Sutherland, Hodgman, "Reentrant Polygon Clipping",
/// Comm. ACM 17(1), 1974.
std::vector<ExactVector> clipped(const std::vector<ExactVector>& polygon, const ExactVector& from,
                                 const ExactVector& to, const std::array<int, 2>& axes) {
  std::vector<ExactVector> result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const ExactVector &p = polygon[i], &q = polygon[i + 1 < polygon.size() ? i + 1 : 0];
    const mpq_class at_p = turn(from, to, p, axes), at_q = turn(from, to, q, axes);
    if (sgn(at_p) >= 0) result.push_back(p);
    if (sgn(at_p) * sgn(at_q) >= 0) continue;
    const mpq_class share = at_p / (at_p - at_q);
    ExactVector& cut = result.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) cut[k] = p[k] + share * (q[k] - p[k]);
  }
  return result;
}

bool has_area(const std::vector<ExactVector>& polygon, const std::array<int, 2>& axes) {
  for (std::size_t i = 2; i < polygon.size(); ++i)
    if (sgn(turn(polygon[0], polygon[i - 1], polygon[i], axes)) != 0) return true;
  return false;
}

PieceCorner add_corner(PlacedPair& pair, CrossingCurves& curves, const ExactVector& p) {
  FlushCorner corner;
  corner.exact.denominator = p[0].get_den() * p[1].get_den() * p[2].get_den();
  corner.exact.numerator = {p[0].get_num() * p[1].get_den() * p[2].get_den(),
                            p[1].get_num() * p[2].get_den() * p[0].get_den(),
                            p[2].get_num() * p[0].get_den() * p[1].get_den()};
  corner.position = pair.to_local(corner.exact.numerator, corner.exact.denominator);
  curves.flush_corners.push_back(std::move(corner));
  return {PieceCorner::Kind::Flush, static_cast<std::uint32_t>(curves.flush_corners.size() - 1)};
}

/// The mean of the corners, which is inside a convex polygon that has an area.
ExactVector middle_of(const std::vector<ExactVector>& polygon) {
  ExactVector sum{0, 0, 0};
  for (const ExactVector& p : polygon)
    for (std::size_t k = 0; k < 3; ++k) sum[k] += p[k];
  for (mpq_class& coordinate : sum) coordinate /= static_cast<unsigned long>(polygon.size());
  return sum;
}

/// What it takes to look whether two triangles of one plane have area in common, and to cut what they have (measured).
constexpr std::uint64_t steps_of_looking = 16, steps_of_cutting = 128;

class FlushSearch {
 public:
  FlushSearch(PlacedPair& pair, CrossingCurves& curves, const Pieces& pieces)
      : pair_(pair), curves_(curves), pieces_(pieces) {
    for (const auto& triangles : curves.flush_pairs)
      for (std::uint32_t side = 0; side < 2; ++side) pieces_in_[side].try_emplace(triangles[side]);
    for (std::uint32_t i = 0; i < pieces.pieces.size(); ++i) {
      const auto found = pieces_in_[pieces.pieces[i].side].find(pieces.pieces[i].triangle);
      if (found != pieces_in_[pieces.pieces[i].side].end()) found->second.push_back(i);
    }
  }

  void add(const std::array<std::uint32_t, 2>& triangles, std::vector<FlushFace>& faces) {
    const Triangle &s = pair_.model(0).triangles[triangles[0]], &t = pair_.model(1).triangles[triangles[1]];
    const PiecePlane plane(pair_, curves_, 0, triangles[0]);
    pair_.count_steps(steps_of_looking);
    if (an_edge_separates(0, s, t, plane.axes()) || an_edge_separates(1, t, s, plane.axes())) return;
    pair_.count_steps(steps_of_cutting);
    std::vector<ExactVector> polygon;
    for (const std::uint32_t v : s) polygon.push_back(to_vector(pair_.exact({0, v})));
    for (std::size_t k = 0; k < 3 && !polygon.empty(); ++k)
      polygon = clipped(polygon, to_vector(pair_.exact({1, t[k]})), to_vector(pair_.exact({1, t[next_corner(k)]})),
                        plane.axes());
    if (!has_area(polygon, plane.axes())) return;
    // If side 0 moves along the normal, its triangle is outside of side 1, and the triangle of side 1 inside of side 0.
    const ExactPoint& p = pair_.exact({0, s[0]});
    const ExactPoint normal = cross(pair_.exact({0, s[1]}) - p, pair_.exact({0, s[2]}) - p);
    const std::uint32_t holder = PlacedPair::motion_along(normal) > 0 ? 1 : 0;
    FlushFace face;
    face.side = 1 - holder;
    face.triangle = triangles[face.side];
    face.piece = piece_around(holder, triangles[holder], polygon);
    if (face.piece == no_index) return;
    for (const ExactVector& corner : polygon) face.corners.push_back(add_corner(pair_, curves_, corner));
    faces.push_back(std::move(face));
  }

 private:
  /// Whether the line along an edge of `triangle` of a side has the whole triangle `other` of the other side on its
  /// right or on it. Two triangles of one plane that turn left have no area in common if and only if an edge of one of
  /// them does so. Most pairs along faces that touch are neighbours without common area, and cutting them exactly takes
  /// several times as long.
  bool an_edge_separates(std::uint32_t side, const Triangle& triangle, const Triangle& other,
                         const std::array<int, 2>& axes) {
    for (std::size_t k = 0; k < 3; ++k) {
      const PairVertex from{side, triangle[k]}, to{side, triangle[next_corner(k)]};
      if (std::all_of(other.begin(), other.end(), [&](std::uint32_t v) {
            return turn_of(from, to, {1 - side, v}, axes) <= 0;
          }))
        return true;
    }
    return false;
  }

  /// Sign of the turn at q on the way from p to r, seen along the third axis.
  int turn_of(PairVertex p, PairVertex q, PairVertex r, const std::array<int, 2>& axes) {
    const auto error = [&](PairVertex v) { return 2 * pair_.error(v.side); };
    const auto seen = [&](PairVertex v) {
      const Vec3& at = pair_.local(v);
      return std::array{coordinate(at, axes[0]), coordinate(at, axes[1])};
    };
    const std::array<double, 2> at_p = seen(p), at_q = seen(q), at_r = seen(r);
    const double h = error(p) + std::max(error(q), error(r));
    const int sign = turn_beyond_error(at_q[0] - at_p[0], at_q[1] - at_p[1], at_r[0] - at_p[0], at_r[1] - at_p[1], h);
    if (sign != 0) return sign;
    const ExactPoint to_q = pair_.exact(q) - pair_.exact(p), to_r = pair_.exact(r) - pair_.exact(p);
    const mpz_class exact_turn =
        coordinate(to_q, axes[0]) * coordinate(to_r, axes[1]) - coordinate(to_q, axes[1]) * coordinate(to_r, axes[0]);
    return sgn(exact_turn);
  }

  /// The piece of a triangle that contains a polygon, which lies in one of its pieces.
  std::uint32_t piece_around(std::uint32_t side, std::uint32_t triangle, const std::vector<ExactVector>& polygon) {
    const std::vector<std::uint32_t>& candidates = pieces_in_[side][triangle];
    if (candidates.size() == 1) return candidates[0];
    const PieceCorner middle = add_corner(pair_, curves_, middle_of(polygon));
    const PiecePlane plane(pair_, curves_, side, triangle);
    const std::span<const PieceCorner> point(&middle, 1);
    for (const std::uint32_t i : candidates) {
      const Piece& piece = pieces_.pieces[i];
      bool is_in = piece.outer == no_index || plane.is_around(pieces_.corners_of(pieces_.cycles[piece.outer]), point);
      for (std::uint32_t hole = piece.holes; hole != no_index && is_in; hole = pieces_.cycles[hole].next_hole)
        is_in = !plane.is_around(pieces_.corners_of(pieces_.cycles[hole]), point);
      if (is_in) return i;
    }
    return no_index;
  }

  PlacedPair& pair_;
  CrossingCurves& curves_;
  const Pieces& pieces_;
  std::array<std::unordered_map<std::uint32_t, std::vector<std::uint32_t>>, 2> pieces_in_;  ///< by side and triangle
};

}  // namespace

std::vector<FlushFace> find_flush_faces(PlacedPair& pair, CrossingCurves& curves, const Pieces& pieces) {
  std::vector<FlushFace> faces;
  if (curves.flush_pairs.empty()) return faces;
  FlushSearch search(pair, curves, pieces);
  for (const std::array<std::uint32_t, 2>& triangles : curves.flush_pairs) search.add(triangles, faces);
  return faces;
}

}  // namespace meshbound
