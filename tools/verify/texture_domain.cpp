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

template <class Number>
Number sum(const std::array<Number, 3>& x) {
  return x[0] + x[1] + x[2];
}

/// Where both lines are 0, as weights times one number.
template <class Number>
std::array<Number, 3> cross_of_lines(const std::array<Number, 3>& p, const std::array<Number, 3>& q) {
  return {p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
}

template <class Number>
std::array<Number, 3> negated(const std::array<Number, 3>& x) {
  const Number zero(0);
  return {zero - x[0], zero - x[1], zero - x[2]};
}

bool is_end(const DomainLine& line, const Eigen::Vector2d& at) {
  return line.from != nullptr && (at == *line.from || at == *line.to);
}

/// Whether the point is known to lie on a line by what it is made of: the line itself, an equal edge, or two other
/// edges that end where this one does. Edges that end at one place and whose functions differ in more than a factor
/// meet in the texture at this place alone.
bool is_made_of(const DomainPoint& point, const DomainLine& line) {
  for (const DomainLine* part : point.lines)
    if (part == &line || (part->from != nullptr && is_end(line, *part->from) && is_end(line, *part->to))) return true;
  const auto& [p, q] = point.lines;
  if (p->from == nullptr || q->from == nullptr) return false;
  return (is_end(*q, *p->from) && is_end(line, *p->from)) || (is_end(*q, *p->to) && is_end(line, *p->to));
}

/// With W the sum of the weights and S that of the shares, both positive:
/// (W S tolerance)^2 - |S (weights of A's corners) - W (shares of B's corners)|^2.
template <class Number>
Number slack(const std::array<Number, 3>& weights, const std::array<Number, 3>& shares,
             const TextureSurface::Triangle& a, const TextureSurface::Triangle& b, double tolerance) {
  const Number all_weights = sum(weights), all_shares = sum(shares);
  const Vec<Number> origin = to_vec<Number>(b.corners[0]);
  Vec<Number> at = (all_shares * weights[0]) * (to_vec<Number>(a.corners[0]) - origin);
  for (std::size_t k = 1; k < 3; ++k) {
    at = at + (all_shares * weights[k]) * (to_vec<Number>(a.corners[k]) - origin);
    at = at - (all_weights * shares[k]) * (to_vec<Number>(b.corners[k]) - origin);
  }
  const Number limit = Number(tolerance) * (all_weights * all_shares);
  return limit * limit - dot(at, at);
}

}  // namespace

TextureDomain::TextureDomain(const TextureSurface::Triangle& a, Work& work) : a_(a), work_(work) {
  std::array<DomainLine*, 3> edges{};
  for (std::size_t k = 0; k < 3; ++k) edges[k] = level(k, 0, 0);
  for (std::size_t k = 0; k < 3; ++k)
    whole_.push_back({crossing(edges[(k + 1) % 3], edges[(k + 2) % 3]), edges[(k + 2) % 3]});
}

std::uint64_t TextureDomain::bits_of_line(DomainLine& line) const {
  const std::array<Exact, 3>& values = exact(line);
  return bits_of(values[0]) + bits_of(values[1]) + bits_of(values[2]);
}

std::uint64_t TextureDomain::bits_of_point(const DomainPoint& point) const {
  return bits_of_line(*point.lines[0]) + bits_of_line(*point.lines[1]);
}

int TextureDomain::turn_of(const std::array<Eigen::Vector2d, 3>& uv) const {
  const Interval area = doubled_area<Interval>(uv[0], uv[1], uv[2]);
  if (surely_positive(area)) return 1;
  if (surely_negative(area)) return -1;
  work_.add_exact(bits_of(uv[0]) + bits_of(uv[1]) + bits_of(uv[2]));
  return sgn(doubled_area<Exact>(uv[0], uv[1], uv[2]));
}

CoveringTriangle TextureDomain::covering(const TextureSurface::Triangle& b) {
  CoveringTriangle result;
  result.triangle = &b;
  const auto& uv = b.coordinates;
  result.turn = turn_of(uv);
  for (std::size_t k = 0; k < 3; ++k) {
    DomainLine& line = lines_.emplace_back();
    line.from = &uv[(k + 1) % 3];
    line.to = &uv[(k + 2) % 3];
    line.sign = result.turn;
    for (std::size_t i = 0; i < 3; ++i)
      line.rough[i] = is_end(line, a_.coordinates[i])
                          ? Interval(0)
                          : Interval(line.sign) * doubled_area<Interval>(*line.from, *line.to, a_.coordinates[i]);
    result.lines[k] = &line;
  }
  return result;
}

DomainLine* TextureDomain::level(std::size_t corner, std::int64_t numerator, int bits) {
  DomainLine& line = lines_.emplace_back();
  line.exact.emplace();
  for (std::size_t i = 0; i < 3; ++i) {
    const double value = (i == corner ? 1.0 : 0.0) - std::ldexp(static_cast<double>(numerator), -bits);
    line.rough[i] = Interval(value);
    (*line.exact)[i] = value;
  }
  return &line;
}

const std::array<Exact, 3>& TextureDomain::exact(DomainLine& line) const {
  if (!line.exact) {
    line.exact.emplace();
    for (std::size_t i = 0; i < 3; ++i)
      (*line.exact)[i] = line.sign * doubled_area<Exact>(*line.from, *line.to, a_.coordinates[i]);
  }
  return *line.exact;
}

std::array<Exact, 3> TextureDomain::exact_weights(const DomainPoint& point) const {
  const std::array<Exact, 3> weights = cross_of_lines(exact(*point.lines[0]), exact(*point.lines[1]));
  return sgn(sum(weights)) < 0 ? negated(weights) : weights;
}

DomainPoint TextureDomain::crossing(DomainLine* line, DomainLine* other) const {
  DomainPoint point{{line, other}, cross_of_lines(line->rough, other->rough)};
  const Interval all = sum(point.rough);
  if (surely_positive(all)) return point;
  if (surely_negative(all)) {
    point.rough = negated(point.rough);
    return point;
  }
  work_.add_exact(bits_of_point(point));
  const std::array<Exact, 3> weights = exact_weights(point);
  const Exact total = sum(weights);
  for (std::size_t k = 0; k < 3; ++k) point.rough[k] = Interval::around(weights[k] / total);
  return point;
}

int TextureDomain::sign_at(DomainLine& line, const DomainPoint& point) const {
  const Interval rough = value_at(line.rough, point.rough);
  if (surely_positive(rough)) return 1;
  if (surely_negative(rough)) return -1;
  if (rough.is_zero() || is_made_of(point, line)) return 0;
  work_.add_exact(bits_of_point(point) + bits_of_line(line));
  return sgn(value_at(exact(line), exact_weights(point)));
}

DomainPolygon TextureDomain::clipped(const DomainPolygon& polygon, DomainLine* line, int side, bool& has_area) {
  work_.add_clip();
  DomainPolygon result;
  std::vector<int> sides;
  bool has_inside = false, has_outside = false;
  for (const DomainCorner& corner : polygon) {
    sides.push_back(side * sign_at(*line, corner.point));
    has_inside = has_inside || sides.back() > 0;
    has_outside = has_outside || sides.back() < 0;
  }
  has_area = has_inside || (side > 0 && !has_outside);
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const int here = sides[i], next = sides[(i + 1) % polygon.size()];
    const auto& [point, to_next] = polygon[i];
    if (here >= 0) result.push_back({point, here == 0 && next < 0 ? line : to_next});
    if (here * next >= 0) continue;
    result.push_back({crossing(to_next, line), here > 0 ? line : to_next});
  }
  return result;
}

bool TextureDomain::is_near(const DomainPoint& point, const CoveringTriangle& b, double tolerance) const {
  std::array<Interval, 3> rough;
  for (std::size_t k = 0; k < 3; ++k) rough[k] = value_at(b.lines[k]->rough, point.rough);
  const Interval rough_slack = slack(point.rough, rough, a_, *b.triangle, tolerance);
  if (surely_not_negative(rough_slack)) return true;
  if (surely_negative(rough_slack)) return false;
  std::uint64_t bits = bits_of_point(point);
  for (std::size_t k = 0; k < 3; ++k)
    bits += bits_of_line(*b.lines[k]) + bits_of(a_.corners[k]) + bits_of(b.triangle->corners[k]);
  work_.add_exact(bits);
  const std::array<Exact, 3> weights = exact_weights(point);
  std::array<Exact, 3> shares;
  for (std::size_t k = 0; k < 3; ++k) shares[k] = value_at(exact(*b.lines[k]), weights);
  return sgn(slack(weights, shares, a_, *b.triangle, tolerance)) >= 0;
}

}  // namespace meshbound::verify
