// SPDX-License-Identifier: MIT
/// Distances between points of a triangle and of a candidate with the same texture coordinate.
#include <algorithm>
#include <cmath>

#include "geometry/longest_edge.h"
#include "geometry/magnitude.h"
#include "geometry/offset_from_triangle.h"
#include "geometry/triangle_corners.h"
#include "numeric/rounding.h"
#include "texture/exact_length.h"
#include "texture/overlay.h"
#include "texture/overlay_numbers.h"

namespace meshbound {
namespace {

ExactPoint exact_point(const Eigen::Vector3d& p, const ExactUnits& units) {
  return {in_units(p.x(), units.position), in_units(p.y(), units.position), in_units(p.z(), units.position)};
}

ExactPoint scaled(const ExactPoint& p, const mpz_class& by) { return {p.x * by, p.y * by, p.z * by}; }

ExactPoint sum_of(const ExactPoint& p, const ExactPoint& q) { return {p.x + q.x, p.y + q.y, p.z + q.z}; }

ExactPoint weighted_corners(const ChartTriangle& t, const std::array<mpz_class, 3>& weights, const ExactUnits& units) {
  ExactPoint p{0, 0, 0};
  for (std::size_t k = 0; k < 3; ++k)
    if (sgn(weights[k]) != 0) p = sum_of(p, scaled(exact_point(t.source->corners[k], units), weights[k]));
  return p;
}

double as_double(const mpz_class& numerator, const mpz_class& denominator, int unit) {
  mpz_class above = numerator, below = denominator;
  if (unit >= 0)
    above <<= static_cast<mp_bitcnt_t>(unit);
  else
    below <<= static_cast<mp_bitcnt_t>(-unit);
  mpq_class quotient(above, below);
  quotient.canonicalize();
  return quotient.get_d();
}

Eigen::Vector3d as_doubles(const ExactPoint& p, const mpz_class& denominator, int unit) {
  return {as_double(p.x, denominator, unit), as_double(p.y, denominator, unit), as_double(p.z, denominator, unit)};
}

/// The length of a vector: an interval, from 0 to infinity where squares would overflow.
Bounds length_bounds(const std::array<Approximate, 3>& v) {
  const double largest = std::max({std::fabs(v[0].value), std::fabs(v[1].value), std::fabs(v[2].value)});
  if (v[0].is_zero() && v[1].is_zero() && v[2].is_zero()) return {0, 0};
  if (!(largest < 0x1p500)) return {};
  const double error = (v[0].error + v[1].error + v[2].error) * Approximate::grown + Approximate::tiny;
  const double length = std::sqrt(v[0].value * v[0].value + v[1].value * v[1].value + v[2].value * v[2].value);
  // The sum of squares and its root round by 3 u, the sums below by 4 u more; what they round of the error, `grown` has
  // room for.
  const double rounding = length * (16 * unit_roundoff);
  Bounds bounds{std::max(0.0, length - error - rounding), length + error + rounding};
  if (largest < 0x1p-300) bounds = {0, next_up(2 * largest + error)};  // squares might underflow
  return bounds.upper >= 0 ? bounds : Bounds{};                        // not a number: nothing is known
}

using NearPoint = Overlay::NearPoint;

NearPoint near_point(const Eigen::Vector3d& p) { return {{{p.x(), 0}, {p.y(), 0}, {p.z(), 0}}}; }

NearPoint operator-(const NearPoint& p, const NearPoint& q) { return {p[0] - q[0], p[1] - q[1], p[2] - q[2]}; }

NearPoint point_between(const NearPoint& from, const NearPoint& to, const Approximate& share) {
  const NearPoint way = to - from;
  return {from[0] + share * way[0], from[1] + share * way[1], from[2] + share * way[2]};
}

/// The largest that a number can be.
Approximate size_of(const Approximate& x) { return {(std::fabs(x.value) + x.error) * Approximate::grown, 0}; }

/// A point on the way from `p` to one of two others, which are known only so far. What is not a number stays none.
NearPoint around(const NearPoint& p, const std::array<NearPoint, 2>& others) {
  NearPoint result = p;
  for (std::size_t i = 0; i < 3; ++i)
    for (const NearPoint& other : others)
      result[i].error +=
          (std::fabs(other[i].value - p[i].value) + other[i].error) * Approximate::grown + Approximate::tiny;
  return result;
}

/// No point of the segment is nearer than the one at a share that may be wrong, less the way between these two.
Bounds distance_to_segment(const NearPoint& p, const NearPoint& from, const NearPoint& to) {
  const NearPoint way = to - from;
  const Approximate share = sum_of_products(p - from, way) / sum_of_products(way, way);
  const double chosen = share.value >= 0 ? std::min(share.value, 1.0) : 0;
  const Bounds there = length_bounds(p - point_between(from, to, {chosen, 0}));
  const double off = share.error < 1 ? share.error : 1;  // both are between the ends
  const double lower = there.lower - next_up(off * length_bounds(way).upper);
  return {lower > 0 ? next_down(lower) : 0, there.upper};
}

TriangleCorners as_vectors(const std::array<Eigen::Vector3d, 3>& corners) {
  TriangleCorners c;
  for (std::size_t k = 0; k < 3; ++k) c[k] = {corners[k].x(), corners[k].y(), corners[k].z()};
  return c;
}

/// Between magnitudes of this and its inverse squares of lengths that matter neither overflow nor underflow.
constexpr double max_plain_magnitude = 0x1p400;

/// The primal and the dual bound of numeric/rounding.h: the triangle lies beyond the plane, across the way to its
/// closest point, through its nearest corner.
Bounds distance_to_triangle(const NearPoint& p, const std::array<Eigen::Vector3d, 3>& corners) {
  const TriangleCorners c = as_vectors(corners);
  const Vec3 point{p[0].value, p[1].value, p[2].value};
  double magnitude = largest_magnitude_of(point);
  for (const Vec3& corner : c) magnitude = std::max(magnitude, largest_magnitude_of(corner));
  const auto [offset, squared] = closest_on_triangle(longest_edge_first(c), point);
  const double length = std::sqrt(squared), of_point = p[0].error + p[1].error + p[2].error,
               slack =
                   (std::max(primal_error, dual_error) * magnitude + of_point) * Approximate::grown + Approximate::tiny;
  if (!(magnitude > 1 / max_plain_magnitude && magnitude < max_plain_magnitude && slack < HUGE_VAL)) return {};
  if (!(length > slack)) return {0, next_up(length * (1 + 8 * unit_roundoff) + slack)};
  double beyond = HUGE_VAL;
  for (const Vec3& corner : c) beyond = std::min(beyond, dot(offset, point - corner) / length);
  return {std::max(0.0, next_down(beyond - slack)), next_up(length * (1 + 8 * unit_roundoff) + slack)};
}

}  // namespace

Bounds distance_bounds(const Eigen::Vector3d& x, const Eigen::Vector3d& y) {
  std::array<Approximate, 3> offset;
  for (Eigen::Index i = 0; i < 3; ++i)
    offset[static_cast<std::size_t>(i)] = Approximate{x[i], 0} - Approximate{y[i], 0};
  return length_bounds(offset);
}

Bounds Overlay::rough_distance(std::uint32_t candidate, const Node& node) {
  Candidate& c = candidates_[candidate];
  if (c.triangle->chart == Chart::Area) return near_distance(c, node);
  if (c.triangle->chart == Chart::Point) return distance_to_triangle(near_position(node), c.triangle->source->corners);
  const auto [across, round] = near_fibre(c, node);
  return distance_to_segment(near_position(node), across, round);
}

Bounds Overlay::distance(std::uint32_t candidate, const Node& node, double precision) {
  return refined(rough_distance(candidate, node), candidate, node, precision);
}

Bounds Overlay::refined(const Bounds& rough, std::uint32_t candidate, const Node& node, double precision) {
  return rough.upper - rough.lower <= precision ? rough : exact_distance(candidates_[candidate], node);
}

/// A corner p of A, less the point of the candidate's plane with its texture coordinate: that is corner 0 plus
/// the shares of the lines 1 and 2 in twice the area of the candidate times the ways to its other corners.
Overlay::Offsets Overlay::offsets_at_corners(const Candidate& candidate) const {
  const TexturedTriangle &a = *a_->source, &b = *candidate.triangle->source;
  Approximate area = doubled_area(b.coordinates[0], b.coordinates[1], b.coordinates[2]);
  if (candidate.triangle->turned) area = -area;
  const Approximate by_area = Approximate{1, 0} / area;
  Offsets offsets;
  for (std::size_t corner = 0; corner < 3; ++corner) {
    const auto line = [&](std::size_t k) { return lines_[candidate.lines[k]].at[corner]; };
    const std::array<bool, 3> is_on = {line(0).is_zero(), line(1).is_zero(), line(2).is_zero()};
    const bool is_end = is_on[0] && is_on[1] != is_on[2];  // equal to corner 1 or 2 of the candidate
    const std::size_t from = is_end ? (is_on[1] ? 2 : 1) : 0;
    const Approximate second = is_end ? Approximate{} : line(1) * by_area,
                      third = is_end ? Approximate{} : line(2) * by_area;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto axis = static_cast<Eigen::Index>(i);
      const auto way = [&](const Eigen::Vector3d& p) {
        return Approximate{p[axis], 0} - Approximate{b.corners[from][axis], 0};
      };
      offsets[i][corner] = way(a.corners[corner]) - (second * way(b.corners[1]) + third * way(b.corners[2]));
    }
  }
  return offsets;
}

Bounds Overlay::near_distance(Candidate& candidate, const Node& node) {
  if (!candidate.offsets) candidate.offsets = offsets_at_corners(candidate);
  const Offsets& offsets = *candidate.offsets;
  if (node.second == Node::is_corner)
    return length_bounds({offsets[0][node.first], offsets[1][node.first], offsets[2][node.first]});
  const Bounds scaled = length_bounds(
      {weighted(offsets[0], node.weights), weighted(offsets[1], node.weights), weighted(offsets[2], node.weights)});
  const Approximate total = sum(node.weights);
  const double most = (std::fabs(total.value) + total.error) * Approximate::grown,
               least = (std::fabs(total.value) - total.error) * (1 - 0x1p-48);
  if (!(least > 0)) return {};
  return {std::max(0.0, scaled.lower / most * (1 - 0x1p-48) - Approximate::tiny),
          scaled.upper / least * Approximate::grown + Approximate::tiny};
}

/// As `fibre` for a segment in the texture, with doubles.
std::array<Overlay::NearPoint, 2> Overlay::near_fibre(const Candidate& candidate, const Node& node) const {
  const ChartTriangle& b = *candidate.triangle;
  const auto uv = texture_points<Approximate>(b, units_);
  const auto &low = uv[b.along[0]], &middle = uv[b.along[1]], &high = uv[b.along[2]];
  const Approximate total = sum(node.weights), length = dot<Approximate>(high - low, high - low),
                    turn = dot<Approximate>(high - low, middle - low),
                    at = weighted(lines_[candidate.lines[2]].at, node.weights) / total;
  const NearPoint first = near_point(b.source->corners[b.along[0]]), second = near_point(b.source->corners[b.along[1]]),
                  last = near_point(b.source->corners[b.along[2]]);
  const Eigen::Vector2d& turns_at = b.source->coordinates[b.along[1]];
  int beyond_turn = 0;
  if (turns_at == b.source->coordinates[b.along[0]])
    beyond_turn = 1;
  else if (turns_at == b.source->coordinates[b.along[2]])
    beyond_turn = -1;
  else
    (void)sign_is_known(at - turn, beyond_turn);
  NearPoint round;
  if (beyond_turn < 0)
    round = point_between(first, second, at / turn);
  else if (beyond_turn > 0)
    round = point_between(second, last, (at - turn) / (length - turn));
  else  // at the turn, or so near that doubles do not tell the side
    round = around(second, {point_between(second, first, size_of(at - turn) / turn),
                            point_between(second, last, size_of(at - turn) / (length - turn))});
  return {point_between(first, last, at / length), round};
}

Overlay::NearPoint Overlay::near_position(const Node& node) const {
  const Approximate total = sum(node.weights);
  NearPoint point;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto corner = [&](std::size_t k) {
      return Approximate{a_->source->corners[k][static_cast<Eigen::Index>(i)], 0};
    };
    point[i] = weighted<Approximate>({corner(0), corner(1), corner(2)}, node.weights) / total;
  }
  return point;
}

/// A point of A, and all points of a candidate with its texture coordinate: a point, a segment or a triangle. All
/// coordinates have one denominator.
struct Overlay::Fibre {
  ExactPoint point;
  std::array<ExactPoint, 3> corners;
  std::size_t corner_count = 1;
  mpz_class denominator;
};

Overlay::Fibre Overlay::fibre(const Candidate& candidate, const Node& node) {
  const ChartTriangle& b = *candidate.triangle;
  const ExactWeights weights = exact(node);
  const mpz_class total = sum(weights);
  const ExactPoint point = weighted_corners(*a_, weights, units_);
  if (b.chart == Chart::Point) {
    Fibre result{point, {}, 3, total};
    for (std::size_t k = 0; k < 3; ++k) result.corners[k] = scaled(exact_point(b.source->corners[k], units_), total);
    return result;
  }
  if (b.chart == Chart::Area) {
    ExactWeights to;
    for (std::size_t k = 0; k < 3; ++k) to[k] = weighted(exact(candidate.lines[k]), weights);
    const mpz_class to_total = sum(to);
    return {scaled(point, to_total), {scaled(weighted_corners(b, to, units_), total)}, 1, total * to_total};
  }
  // The candidate is a segment in the texture. The points with one coordinate run from the edge between the ends of the
  // segment to one of the two other edges, at the same share of the way along the segment.
  const auto uv = texture_points<mpz_class>(b, units_);
  const auto &low = uv[b.along[0]], &middle = uv[b.along[1]], &high = uv[b.along[2]];
  const auto corner = [&](std::size_t k) { return exact_point(b.source->corners[b.along[k]], units_); };
  const mpz_class length = dot<mpz_class>(high - low, high - low), turn = dot<mpz_class>(high - low, middle - low);
  const mpz_class at = weighted(exact(candidate.lines[2]), weights);
  const bool is_before = sgn(turn) > 0 && at <= total * turn;
  const mpz_class start = is_before ? mpz_class(0) : turn, part = is_before ? turn : mpz_class(length - turn);
  const mpz_class left = total * length - at, along_part = at - total * start;
  const ExactPoint across = sum_of(scaled(corner(0), left), scaled(corner(2), at));
  const ExactPoint round = sum_of(scaled(corner(is_before ? 0 : 1), total * part - along_part),
                                  scaled(corner(is_before ? 1 : 2), along_part));
  return {scaled(point, length * part), {scaled(across, part), scaled(round, length)}, 2, total * length * part};
}

Bounds Overlay::exact_distance(const Candidate& candidate, const Node& node) {
  const Fibre f = fibre(candidate, node);
  SquaredLength squared;
  if (f.corner_count == 1) {
    const ExactPoint offset = f.point - f.corners[0];
    squared = {dot(offset, offset), 1};
  } else {
    squared = f.corner_count == 2 ? squared_distance_to_segment(f.point, f.corners[0], f.corners[1])
                                  : squared_distance_to_triangle(f.point, f.corners);
  }
  squared.denominator *= f.denominator * f.denominator;
  return root_bounds(squared, units_.position);
}

std::array<Eigen::Vector3d, 2> Overlay::ends_of_fibre(std::uint32_t candidate, const Node& node, double precision) {
  const Candidate& c = candidates_[candidate];
  std::array<Eigen::Vector3d, 2> ends;
  if (c.triangle->chart == Chart::Segment) {
    double error = 0;
    const std::array<NearPoint, 2> near = near_fibre(c, node);
    for (std::size_t k = 0; k < 2; ++k) {
      ends[k] = {near[k][0].value, near[k][1].value, near[k][2].value};
      for (const Approximate& x : near[k]) error += x.error;
    }
    if (error <= precision) return ends;
  }
  const Fibre f = fibre(c, node);
  for (std::size_t k = 0; k < 2; ++k)
    ends[k] = as_doubles(f.corners[std::min(k, f.corner_count - 1)], f.denominator, units_.position);
  return ends;
}

TextureWitness Overlay::witness(std::uint32_t candidate, const Node& node) {
  const Candidate& c = candidates_[candidate];
  const Fibre f = fibre(c, node);
  std::array<Eigen::Vector3d, 3> corners;
  for (std::size_t k = 0; k < 3; ++k)
    corners[k] = as_doubles(f.corners[std::min(k, f.corner_count - 1)], f.denominator, units_.position);
  TextureWitness witness;
  witness.from = {as_doubles(f.point, f.denominator, units_.position), a_->source->triangle};
  const Eigen::Vector3d& from = witness.from.position;
  witness.nearest = {from - offset_from_triangle(corners, from), c.triangle->source->triangle};
  const std::array<double, 3> weights = rounded(node);
  for (std::size_t i = 0; i < 3; ++i) witness.coordinate += weights[i] * a_->source->coordinates[i];
  witness.distance = (from - witness.nearest.position).stableNorm();
  return witness;
}

}  // namespace meshbound
