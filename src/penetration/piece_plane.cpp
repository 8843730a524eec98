// SPDX-License-Identifier: MIT
#include "penetration/piece_plane.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "numeric/rounding.h"
#include "penetration/pieces.h"

namespace meshbound {
const Vec3& position_of(PlacedPair& pair, const CrossingCurves& curves, std::uint32_t side, PieceCorner corner) {
  if (corner.kind == PieceCorner::Kind::Vertex) return pair.local({side, corner.index});
  return corner.kind == PieceCorner::Kind::Node ? curves.nodes[corner.index].position
                                                : curves.flush_corners[corner.index].position;
}

double error_of(const PlacedPair& pair, const CrossingCurves& curves, std::uint32_t side, PieceCorner corner) {
  if (corner.kind == PieceCorner::Kind::Vertex) return 2 * pair.error(side);
  return corner.kind == PieceCorner::Kind::Node ? curves.nodes[corner.index].error : rounded_error;
}

ExactNode exact_position_of(PlacedPair& pair, const CrossingCurves& curves, std::uint32_t side, PieceCorner corner) {
  if (corner.kind == PieceCorner::Kind::Vertex) return {pair.exact({side, corner.index}), 1};
  return corner.kind == PieceCorner::Kind::Node ? exact_position(pair, curves.nodes[corner.index])
                                                : curves.flush_corners[corner.index].exact;
}

PiecePlane::PiecePlane(PlacedPair& pair, const CrossingCurves& curves, std::uint32_t side, std::uint32_t triangle)
    : pair_(&pair), curves_(&curves), side_(side) {
  const Triangle& t = pair.model(side).triangles[triangle];
  const PairVertex p{side, t[0]}, q{side, t[1]}, r{side, t[2]};
  const Vec3 n = meshbound::cross(pair.local(q) - pair.local(p), pair.local(r) - pair.local(p));
  int axis = std::fabs(n.x) >= std::fabs(n.y) ? 0 : 1;
  if (std::fabs(n.z) > std::fabs(coordinate(n, axis))) axis = 2;
  // A component of at most 2 has roundings of at most 32 u, and the errors of the vertices change it by at most 32
  // errors.
  int sign = coordinate(n, axis) > 0 ? 1 : -1;
  if (std::fabs(coordinate(n, axis)) <= 64 * unit_roundoff + 32 * pair.error(side)) {
    const ExactPoint exact_normal = cross(pair.exact(q) - pair.exact(p), pair.exact(r) - pair.exact(p));
    if (sgn(coordinate(exact_normal, axis)) == 0)
      axis = sgn(exact_normal.x) != 0 ? 0 : (sgn(exact_normal.y) != 0 ? 1 : 2);
    sign = sgn(coordinate(exact_normal, axis));
  }
  first_ = (axis + 1) % 3;
  second_ = (axis + 2) % 3;
  if (sign < 0) std::swap(first_, second_);
}

double PiecePlane::x(PieceCorner corner) const { return coordinate(position(corner), first_); }
double PiecePlane::y(PieceCorner corner) const { return coordinate(position(corner), second_); }

PiecePlane::Seen PiecePlane::see(PieceCorner corner) const {
  const Vec3& p = position(corner);
  return {corner, coordinate(p, first_), coordinate(p, second_), error(corner)};
}

PiecePlane::Flat PiecePlane::exact(PieceCorner corner) const {
  const ExactNode node = exact_position_of(*pair_, *curves_, side_, corner);
  return {coordinate(node.numerator, first_), coordinate(node.numerator, second_), node.denominator};
}

/// The edge of this triangle's model that a node lies on, if it is not within the triangle.
std::uint32_t PiecePlane::edge_with(PieceCorner corner) const {
  if (corner.kind != PieceCorner::Kind::Node) return no_index;
  const CurveNode& node = curves_->nodes[corner.index];
  return node.side == side_ ? node.edge : no_index;
}

bool PiecePlane::is_on_edge(PieceCorner corner, std::uint32_t edge) const {
  const ModelEdge& ends = pair_->model(side_).edges[edge];
  if (corner.kind == PieceCorner::Kind::Vertex) return corner.index == ends.from || corner.index == ends.to;
  return edge_with(corner) == edge;
}

/// Planes of the other model that pass through a node, by their numbers there.
std::array<std::uint32_t, 2> PiecePlane::planes_through(PieceCorner corner) const {
  if (corner.kind != PieceCorner::Kind::Node) return {no_index, no_index};
  const CurveNode& node = curves_->nodes[corner.index];
  const ClosedModel::Data& other = pair_->model(1 - side_);
  if (node.side == side_) return {other.plane_of[node.triangle], other.plane_of[node.triangle]};
  const std::array<std::uint32_t, 2>& triangles = other.edges[node.edge].triangle;
  return {other.plane_of[triangles[0]], other.plane_of[triangles[1]]};
}

/// Whether it follows from what the corners are that they lie in one line: all on one edge of the triangle, or all in
/// one plane of the other model. That plane is not the triangle's, as a node's edge is not parallel to the triangle
/// that it goes through.
bool PiecePlane::are_in_line(PieceCorner p, PieceCorner q, PieceCorner r) const {
  for (const PieceCorner corner : {p, q, r})
    if (const std::uint32_t edge = edge_with(corner); edge != no_index)
      if (is_on_edge(p, edge) && is_on_edge(q, edge) && is_on_edge(r, edge)) return true;
  const std::array<std::uint32_t, 2> at_q = planes_through(q), at_r = planes_through(r);
  for (const std::uint32_t plane : planes_through(p))
    if (plane != no_index && (plane == at_q[0] || plane == at_q[1]) && (plane == at_r[0] || plane == at_r[1]))
      return true;
  return false;
}

int PiecePlane::exact_turn(PieceCorner p, PieceCorner q, PieceCorner r) const {
  if (are_in_line(p, q, r)) return 0;
  pair_->count_exact_decision();
  const Flat a = exact(p), b = exact(q), c = exact(r);
  const mpz_class determinant =
      a.w * (b.x * c.y - b.y * c.x) - b.w * (a.x * c.y - a.y * c.x) + c.w * (a.x * b.y - a.y * b.x);
  return sgn(determinant);
}

double PiecePlane::area(std::span<const PieceCorner> cycle) const {
  double sum = 0;
  for (std::size_t i = 1; i + 1 < cycle.size(); ++i)
    sum += (x(cycle[i]) - x(cycle[0])) * (y(cycle[i + 1]) - y(cycle[0])) -
           (y(cycle[i]) - y(cycle[0])) * (x(cycle[i + 1]) - x(cycle[0]));
  return sum;
}

int PiecePlane::area_sign(std::span<const std::span<const PieceCorner>> cycles) const {
  double extent = 0, largest_error = 0, value = 0, n = 0;
  for (const std::span<const PieceCorner> cycle : cycles) {
    for (const PieceCorner& corner : cycle) {
      extent = std::max({extent, std::fabs(x(corner) - x(cycle[0])), std::fabs(y(corner) - y(cycle[0]))});
      largest_error = std::max(largest_error, error(corner));
    }
    value += area(cycle);
    n += static_cast<double>(cycle.size());
  }
  // Each of n terms is at most 2 extent^2, off by 8 h (extent + h) and a few roundings, and the sum by n more.
  const double h = 2 * largest_error;
  const double bound = n * (8 * h * (extent + h) + (16 + 2 * n) * unit_roundoff * 2 * extent * extent) + 0x1p-1000;
  if (value > bound) return 1;
  if (value < -bound) return -1;
  mpq_class sum = 0;
  for (const std::span<const PieceCorner> cycle : cycles)
    for (std::size_t i = 0; i < cycle.size(); ++i) {
      const Flat p = exact(cycle[i]), q = exact(cycle[i + 1 < cycle.size() ? i + 1 : 0]);
      mpq_class term(p.x * q.y - p.y * q.x, p.w * q.w);
      term.canonicalize();
      sum += term;
    }
  return sgn(sum);
}

bool PiecePlane::is_around(std::span<const PieceCorner> outer, std::span<const PieceCorner> inner) const {
  for (const PieceCorner& p : inner) {
    count_steps(outer.size());
    bool inside = false, on_line = false;
    for (std::size_t i = 0; i < outer.size() && !on_line; ++i) {
      const PieceCorner &a = outer[i], &b = outer[i + 1 < outer.size() ? i + 1 : 0];
      // An edge counts if its ends are on different sides of the horizontal line through p; ends on the line count as
      // above it. If p is this close to an edge, another corner of `inner` decides.
      const double margin = error(a) + error(b) + error(p);
      const bool a_above = y(a) >= y(p), b_above = y(b) >= y(p);
      on_line = std::fabs(y(a) - y(p)) <= margin && std::fabs(x(a) - x(p)) <= margin;
      if (a_above == b_above) continue;
      const int side = turn(a, b, p);
      on_line = on_line || side == 0;
      if ((side > 0) == b_above) inside = !inside;
    }
    if (!on_line) return inside;
  }
  return false;
}

}  // namespace meshbound
