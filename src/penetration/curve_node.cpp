// SPDX-License-Identifier: MIT
// Positions of the nodes of the curves: in doubles with an error bound, and exactly.
#include <algorithm>
#include <cmath>
#include <limits>

#include "numeric/rounding.h"
#include "penetration/curves.h"

namespace meshbound {
namespace {

/// A position on an edge, as a share of the way from its first vertex.
struct Parameter {
  double value = 0;
  double error = std::numeric_limits<double>::infinity();
};

/// A node as the edge and the triangle that it goes through.
struct NodeParts {
  PairVertex from, to;
  std::array<PairVertex, 3> triangle;
};

NodeParts parts_of(const PlacedPair& pair, const CurveNode& node) {
  const ModelEdge& edge = pair.model(node.side).edges[node.edge];
  const std::uint32_t other = 1 - node.side;
  const Triangle& t = pair.model(other).triangles[node.triangle];
  return {{node.side, edge.from}, {node.side, edge.to}, {{{other, t[0]}, {other, t[1]}, {other, t[2]}}}};
}

/// The parameter h_p / (h_p - h_q), with h the heights of the ends over the plane times the length of the normal. An
/// error of E in both heights changes it by at most E / (|h_p - h_q| - 2 E) on either side.
Parameter parameter_of(PlacedPair& pair, const NodeParts& parts) {
  const Vec3 p = pair.local(parts.from), q = pair.local(parts.to);
  const Vec3 a = pair.local(parts.triangle[0]), ab = pair.local(parts.triangle[1]) - a,
             ac = pair.local(parts.triangle[2]) - a;
  const Vec3 n = cross(ab, ac), ap = p - a, aq = q - a;
  const double at_p = dot(n, ap), at_q = dot(n, aq);
  const double h = 2 * std::max(pair.error(0), pair.error(1));
  const auto sum = [h](const Vec3& v) { return std::fabs(v.x) + std::fabs(v.y) + std::fabs(v.z) + 3 * h; };
  const double sides = sum(ab) * sum(ac), reach = std::max(sum(ap), sum(aq));
  // As in `orientation`, with sums of magnitudes instead of their largest.
  const double error = 64 * unit_roundoff * sides * reach + 6 * h * (sides + (sum(ab) + sum(ac)) * reach);
  const double difference = std::fabs(at_p - at_q);
  if (!(difference > 8 * error) || !(difference > 1e-200)) return {};
  return {std::clamp(at_p / (at_p - at_q), 0.0, 1.0), 2 * error / (difference - 4 * error) + 4 * unit_roundoff};
}

struct ExactHeights {
  mpz_class at_from, drop;  ///< height of the first end over the plane, and by how much the other end is lower
};

ExactHeights exact_heights(PlacedPair& pair, const NodeParts& parts) {
  const ExactPoint &a = pair.exact(parts.triangle[0]), &b = pair.exact(parts.triangle[1]),
                   &c = pair.exact(parts.triangle[2]), &p = pair.exact(parts.from), &q = pair.exact(parts.to);
  const ExactPoint n = cross(b - a, c - a);
  return {dot(n, p - a), dot(n, p - q)};
}

ExactPoint normal_of(PlacedPair& pair, const NodeParts& parts) {
  const ExactPoint &a = pair.exact(parts.triangle[0]), &b = pair.exact(parts.triangle[1]),
                   &c = pair.exact(parts.triangle[2]);
  return cross(b - a, c - a);
}

}  // namespace

ExactNode exact_position(PlacedPair& pair, const CurveNode& node) {
  const NodeParts parts = parts_of(pair, node);
  auto [height, drop] = exact_heights(pair, parts);
  if (sgn(drop) < 0) {
    drop = -drop;
    height = -height;
  }
  const ExactPoint &p = pair.exact(parts.from), &q = pair.exact(parts.to);
  return {{p.x * drop + (q.x - p.x) * height, p.y * drop + (q.y - p.y) * height, p.z * drop + (q.z - p.z) * height},
          drop};
}

void set_position(PlacedPair& pair, double max_error, CurveNode& node) {
  const NodeParts parts = parts_of(pair, node);
  const Parameter t = parameter_of(pair, parts);
  const Vec3 p = pair.local(parts.from), q = pair.local(parts.to), d = q - p;
  // The ends are off by their errors, at most sqrt(3) of them as a length; a cut as in numeric/rounding.h, with
  // coordinates of magnitude 1 at most.
  node.error = t.error * length(d) * (1 + 0x1p-40) + 2 * pair.error(node.side) + cut_error;
  node.position = p + t.value * d;
  if (node.error <= max_error) return;
  const ExactNode exact = exact_position(pair, node);
  node.position = pair.to_local(exact.numerator, exact.denominator);
  node.error = rounded_error;
}

bool comes_before(PlacedPair& pair, const CurveNode& a, const CurveNode& b) {
  const NodeParts parts_a = parts_of(pair, a), parts_b = parts_of(pair, b);
  const Parameter at_a = parameter_of(pair, parts_a), at_b = parameter_of(pair, parts_b);
  const double error = at_a.error + at_b.error;
  if (at_a.value + error < at_b.value) return true;
  if (at_b.value + error < at_a.value) return false;
  const ExactHeights of_a = exact_heights(pair, parts_a), of_b = exact_heights(pair, parts_b);
  const int turned = sgn(of_a.drop) * sgn(of_b.drop);
  const mpz_class difference = of_a.at_from * of_b.drop - of_b.at_from * of_a.drop;
  if (sgn(difference) != 0) return turned * sgn(difference) < 0;
  // How much both heights change: the product of the normal with the motion of side 0, with the opposite sign if side 0
  // has the triangle.
  const ExactPoint normal_a = normal_of(pair, parts_a), normal_b = normal_of(pair, parts_b);
  const int moved = a.side == 0 ? turned : -turned;
  for (const auto coordinate : {&ExactPoint::x, &ExactPoint::y, &ExactPoint::z}) {
    const mpz_class slope = normal_a.*coordinate * of_b.drop - normal_b.*coordinate * of_a.drop;
    if (sgn(slope) != 0) return moved * sgn(slope) < 0;
  }
  return false;
}

}  // namespace meshbound
