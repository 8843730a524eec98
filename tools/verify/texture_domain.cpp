// SPDX-License-Identifier: MIT
#include "verify/texture_domain.h"

#include <utility>

namespace meshbound::verify {
namespace {

/// Twice the area of a triangle in the texture.
template <class Number>
Number doubled_area(const Eigen::Vector2d& p, const Eigen::Vector2d& q, const Eigen::Vector2d& r) {
  const Number px(p.x()), py(p.y());
  return (Number(q.x()) - px) * (Number(r.y()) - py) - (Number(q.y()) - py) * (Number(r.x()) - px);
}

template <class Number>
Number value_at(const std::array<Number, 3>& line, const std::array<Number, 3>& weights) {
  return line[0] * weights[0] + line[1] * weights[1] + line[2] * weights[2];
}

DomainPoint point_of(std::array<Exact, 3> weights) {
  DomainPoint point{std::move(weights), {}};
  for (std::size_t k = 0; k < 3; ++k) point.rough[k] = Interval::around(point.weights[k]);
  return point;
}

/// |sum of weights * A's corners * s - sum of shares * B's corners| <= tolerance * s, s being the sum of the shares.
template <class Number>
Number slack(const std::array<Number, 3>& weights, const std::array<Number, 3>& shares,
             const TextureSurface::Triangle& a, const TextureSurface::Triangle& b, double tolerance) {
  const Number sum = shares[0] + shares[1] + shares[2];
  const Vec<Number> origin = to_vec<Number>(b.corners[0]);
  Vec<Number> at = sum * (weights[0] * (to_vec<Number>(a.corners[0]) - origin));
  for (std::size_t k = 1; k < 3; ++k) at = at + sum * (weights[k] * (to_vec<Number>(a.corners[k]) - origin));
  for (std::size_t k = 1; k < 3; ++k) at = at - shares[k] * (to_vec<Number>(b.corners[k]) - origin);
  const Number limit = Number(tolerance) * sum;
  return limit * limit - dot(at, at);
}

}  // namespace

DomainPolygon TextureDomain::whole() {
  DomainPolygon polygon(3);
  for (std::size_t k = 0; k < 3; ++k) {
    polygon[k].weights[k] = 1;
    polygon[k].rough[k] = Interval(1);
  }
  return polygon;
}

CoveringTriangle TextureDomain::covering(const TextureSurface::Triangle& b) const {
  CoveringTriangle result;
  result.triangle = &b;
  const auto& uv = b.coordinates;
  const Interval area = doubled_area<Interval>(uv[0], uv[1], uv[2]);
  result.turn = surely_positive(area) ? 1 : surely_negative(area) ? -1 : sgn(doubled_area<Exact>(uv[0], uv[1], uv[2]));
  for (std::size_t k = 0; k < 3; ++k) {
    DomainLine& line = result.lines[k];
    line.from = &uv[(k + 1) % 3];
    line.to = &uv[(k + 2) % 3];
    line.sign = result.turn;
    for (std::size_t i = 0; i < 3; ++i)
      line.rough[i] = Interval(line.sign) * doubled_area<Interval>(*line.from, *line.to, a_.coordinates[i]);
  }
  return result;
}

DomainLine TextureDomain::level(std::size_t corner, std::int64_t numerator, int bits) {
  DomainLine line;
  line.exact.emplace();
  for (std::size_t i = 0; i < 3; ++i) {
    const double value = (i == corner ? 1.0 : 0.0) - std::ldexp(static_cast<double>(numerator), -bits);
    line.rough[i] = Interval(value);
    (*line.exact)[i] = value;
  }
  return line;
}

const std::array<Exact, 3>& TextureDomain::exact(DomainLine& line) const {
  if (!line.exact) {
    line.exact.emplace();
    for (std::size_t i = 0; i < 3; ++i)
      (*line.exact)[i] = line.sign * doubled_area<Exact>(*line.from, *line.to, a_.coordinates[i]);
  }
  return *line.exact;
}

int TextureDomain::sign_at(DomainLine& line, const DomainPoint& point) const {
  const Interval rough = value_at(line.rough, point.rough);
  if (surely_positive(rough)) return 1;
  if (surely_negative(rough)) return -1;
  return sgn(value_at(exact(line), point.weights));
}

DomainPolygon TextureDomain::clipped(const DomainPolygon& polygon, DomainLine& line, int side, bool& has_area) const {
  ++work_;
  DomainPolygon result;
  std::vector<int> sides;
  bool has_inside = false, has_outside = false;
  for (const DomainPoint& point : polygon) {
    sides.push_back(side * sign_at(line, point));
    has_inside = has_inside || sides.back() > 0;
    has_outside = has_outside || sides.back() < 0;
  }
  has_area = has_inside || (side > 0 && !has_outside);
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const std::size_t next = (i + 1) % polygon.size();
    if (sides[i] >= 0) result.push_back(polygon[i]);
    if (sides[i] * sides[next] >= 0) continue;
    const Exact here = value_at(exact(line), polygon[i].weights), there = value_at(exact(line), polygon[next].weights);
    std::array<Exact, 3> weights;
    for (std::size_t k = 0; k < 3; ++k)
      weights[k] = (polygon[next].weights[k] * here - polygon[i].weights[k] * there) / (here - there);
    result.push_back(point_of(std::move(weights)));
  }
  return result;
}

bool TextureDomain::is_near(const DomainPoint& point, CoveringTriangle& b, double tolerance) const {
  std::array<Interval, 3> rough;
  for (std::size_t k = 0; k < 3; ++k) rough[k] = value_at(b.lines[k].rough, point.rough);
  const Interval rough_slack = slack(point.rough, rough, a_, *b.triangle, tolerance);
  if (surely_not_negative(rough_slack)) return true;
  if (surely_negative(rough_slack)) return false;
  std::array<Exact, 3> shares;
  for (std::size_t k = 0; k < 3; ++k) shares[k] = value_at(exact(b.lines[k]), point.weights);
  return sgn(slack(point.weights, shares, a_, *b.triangle, tolerance)) >= 0;
}

}  // namespace meshbound::verify
