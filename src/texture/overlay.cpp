// SPDX-License-Identifier: MIT
#include "texture/overlay.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/longest_edge.h"

namespace meshbound {
namespace {

/// A number type in which a line is evaluated: doubles with an error bound, or integers.
template <class Number>
struct TexturePoint {
  Number x, y;
};

template <class Number>
Number number_of(double x, const ExactUnits& units);
template <>
Approximate number_of<Approximate>(double x, const ExactUnits& /*units*/) {
  return {x, 0};
}
template <>
mpz_class number_of<mpz_class>(double x, const ExactUnits& units) {
  return in_units(x, units.texture);
}

template <class Number>
std::array<TexturePoint<Number>, 3> texture_points(const ChartTriangle& t, const ExactUnits& units) {
  std::array<TexturePoint<Number>, 3> points;
  for (std::size_t k = 0; k < 3; ++k) {
    points[k].x = number_of<Number>(t.source->coordinates[k].x(), units);
    points[k].y = number_of<Number>(t.source->coordinates[k].y(), units);
  }
  return points;
}

template <class Number>
TexturePoint<Number> operator-(const TexturePoint<Number>& p, const TexturePoint<Number>& q) {
  return {Number(p.x - q.x), Number(p.y - q.y)};
}
template <class Number>
Number cross(const TexturePoint<Number>& p, const TexturePoint<Number>& q) {
  return Number(p.x * q.y) - Number(p.y * q.x);
}
template <class Number>
Number dot(const TexturePoint<Number>& p, const TexturePoint<Number>& q) {
  return Number(p.x * q.x) + Number(p.y * q.y);
}

/// Value of line `number` of candidate `t` at the texture coordinate `at`; `b` holds the texture coordinates of `t`.
template <class Number>
Number line_at(const ChartTriangle& t, const std::array<TexturePoint<Number>, 3>& b, std::uint32_t number,
               const TexturePoint<Number>& at) {
  if (t.chart == Chart::Area) {  // twice the area between edge and point
    const TexturePoint<Number>&from = b[(number + 1) % 3], &to = b[(number + 2) % 3];
    const Number area = cross<Number>(to - from, at - from);
    return t.turned ? Number(-area) : area;
  }
  Number value;
  if (t.chart == Chart::Segment) {  // both sides of it, then beyond its ends
    const TexturePoint<Number>&from = b[t.along[0]], &to = b[t.along[2]];
    if (number < 2)
      value = cross<Number>(to - from, at - from);
    else
      value = number == 2 ? dot<Number>(to - from, at - from) : dot<Number>(to - from, to - at);
    return number == 1 ? Number(-value) : value;
  }
  value = number < 2 ? Number(at.x - b[0].x) : Number(at.y - b[0].y);
  return number % 2 == 1 ? Number(-value) : value;
}

template <class Number>
Number weighted(const std::array<Number, 3>& line, const std::array<Number, 3>& weights) {
  return Number(line[0] * weights[0]) + Number(line[1] * weights[1]) + Number(line[2] * weights[2]);
}

template <class Number>
std::array<Number, 3> cross_of_lines(const std::array<Number, 3>& p, const std::array<Number, 3>& q) {
  return {Number(Number(p[1] * q[2]) - Number(p[2] * q[1])), Number(Number(p[2] * q[0]) - Number(p[0] * q[2])),
          Number(Number(p[0] * q[1]) - Number(p[1] * q[0]))};
}

template <class Number>
Number sum(const std::array<Number, 3>& x) {
  return Number(x[0] + x[1]) + x[2];
}

template <class Number>
void negate(std::array<Number, 3>& x) {
  for (Number& k : x) k = -k;
}

/// Approximations of three integers up to a common factor that brings the largest below 1.
std::array<Approximate, 3> near(const std::array<mpz_class, 3>& exact) {
  std::array<double, 3> leading{};
  std::array<long, 3> exponent{};
  long largest = 0;
  bool is_first = true;
  for (std::size_t i = 0; i < 3; ++i) {
    if (sgn(exact[i]) == 0) continue;
    leading[i] = mpz_get_d_2exp(&exponent[i], exact[i].get_mpz_t());  // truncated: error below 2^-52 of it
    largest = is_first ? exponent[i] : std::max(largest, exponent[i]);
    is_first = false;
  }
  std::array<Approximate, 3> result;
  for (std::size_t i = 0; i < 3; ++i) {
    if (sgn(exact[i]) == 0) continue;
    const double value = std::ldexp(leading[i], static_cast<int>(std::max(exponent[i] - largest, -2000L)));
    result[i] = {value, std::fabs(value) * 0x1p-51 + Approximate::tiny};
  }
  return result;
}

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
  const double rounding = length * (8 * unit_roundoff);  // 3 u by the sum of squares and its root
  Bounds bounds{std::max(0.0, next_down(length - error - rounding)), next_up(length + error + rounding)};
  if (largest < 0x1p-300) bounds = {0, next_up(2 * largest + error)};  // squares might underflow
  return bounds.upper >= 0 ? bounds : Bounds{};                        // not a number: nothing is known
}

/// The point of a triangle that is nearest to p, rounded.
Eigen::Vector3d nearest_on(const std::array<Eigen::Vector3d, 3>& corners, const Eigen::Vector3d& p) {
  std::array<Vec3, 3> c;
  for (std::size_t k = 0; k < 3; ++k) c[k] = {corners[k].x(), corners[k].y(), corners[k].z()};
  const Vec3 offset = closest_on_triangle(longest_edge_first(c), Vec3{p.x(), p.y(), p.z()}).offset;
  return p - Eigen::Vector3d(offset.x, offset.y, offset.z);
}

using Ends = std::array<const Eigen::Vector2d*, 2>;

/// The ends of the edge opposite to a corner.
Ends edge_of(const ChartTriangle& t, std::size_t corner) {
  const auto& uv = t.source->coordinates;
  return {&uv[(corner + 1) % 3], &uv[(corner + 2) % 3]};
}

bool is_end(const Ends& ends, const Eigen::Vector2d& at) {
  return ends[0] != nullptr && (*ends[0] == at || *ends[1] == at);
}

}  // namespace

Bounds distance_bounds(const Eigen::Vector3d& x, const Eigen::Vector3d& y) {
  std::array<Approximate, 3> offset;
  for (Eigen::Index i = 0; i < 3; ++i)
    offset[static_cast<std::size_t>(i)] = Approximate{x[i], 0} - Approximate{y[i], 0};
  return length_bounds(offset);
}

ChartTriangle chart_triangle(const TexturedTriangle& triangle, const ExactUnits& units) {
  ChartTriangle result{&triangle, Chart::Area, false, {0, 1, 2}};
  const auto points = texture_points<Approximate>(result, units);
  const Approximate near_area = cross<Approximate>(points[1] - points[0], points[2] - points[0]);
  int turn = 0;
  if (!sign_is_known(near_area, turn)) {
    const auto exact_points = texture_points<mpz_class>(result, units);
    turn = sgn(cross<mpz_class>(exact_points[1] - exact_points[0], exact_points[2] - exact_points[0]));
  }
  result.turned = turn < 0;
  if (turn != 0) return result;
  const auto& uv = triangle.coordinates;
  std::sort(result.along.begin(), result.along.end(), [&](std::uint8_t p, std::uint8_t q) {
    return std::pair(uv[p].x(), uv[p].y()) < std::pair(uv[q].x(), uv[q].y());
  });
  result.chart = uv[result.along[0]] == uv[result.along[2]] ? Chart::Point : Chart::Segment;
  return result;
}

void Overlay::begin(const ChartTriangle& a) {
  a_ = &a;
  lines_.clear();
  candidates_.clear();
  for (std::size_t i = 0; i < 3; ++i) {
    LineData line;
    line.exact = std::make_unique<ExactWeights>();
    line.at[i] = {1, 0};
    (*line.exact)[i] = 1;
    if (a.chart == Chart::Area) line.ends = edge_of(a, i);
    lines_.push_back(std::move(line));
  }
}

void Overlay::add(const ChartTriangle& b) {
  Candidate candidate{&b, {}, static_cast<std::uint8_t>(b.chart == Chart::Area ? 3 : 4)};
  const auto points = texture_points<Approximate>(b, units_);
  const auto at = texture_points<Approximate>(*a_, units_);
  for (std::uint32_t number = 0; number < candidate.line_count; ++number) {
    candidate.lines[number] = static_cast<Line>(lines_.size());
    LineData line;
    line.candidate = candidates();
    line.number = number;
    if (b.chart == Chart::Area) line.ends = edge_of(b, number);
    bool is_beyond = true;
    for (std::size_t i = 0; i < 3; ++i) {
      if (!is_end(line.ends, a_->source->coordinates[i])) line.at[i] = line_at(b, points, number, at[i]);
      is_beyond = is_beyond && line.at[i].value < -line.at[i].error;
    }
    if (is_beyond) {
      lines_.resize(candidate.lines[0]);
      return;
    }
    lines_.push_back(std::move(line));
  }
  candidates_.push_back(candidate);
}

Overlay::Line Overlay::add_level(std::size_t corner, std::int64_t numerator) {
  constexpr std::int64_t one = std::int64_t{1} << 40;
  LineData line;
  line.exact = std::make_unique<ExactWeights>();
  for (std::size_t i = 0; i < 3; ++i) {
    const std::int64_t value = (i == corner ? one : 0) - numerator;
    line.at[i] = {static_cast<double>(value), 0};
    (*line.exact)[i] = static_cast<long>(value);
  }
  lines_.push_back(std::move(line));
  return static_cast<Line>(lines_.size() - 1);
}

Overlay::Polygon Overlay::whole() const {
  Polygon polygon(3);
  for (Line i = 0; i < 3; ++i) {
    polygon[i].node.first = i;
    polygon[i].node.weights[i] = {1, 0};
    polygon[i].node.at = &a_->source->coordinates[i];
    polygon[i].to_next = (i + 2) % 3;
  }
  return polygon;
}

std::span<const Overlay::Line> Overlay::lines_of(std::uint32_t candidate) const {
  const Candidate& c = candidates_[candidate];
  return std::span(c.lines).first(c.line_count);
}

Overlay::Node Overlay::given(const std::array<double, 3>& weights) {
  Node node;
  node.second = Node::is_given;
  node.given = weights;
  for (std::size_t i = 0; i < 3; ++i) node.weights[i] = {weights[i], 0};
  return node;
}

const Overlay::ExactWeights& Overlay::exact(Line line) {
  LineData& data = lines_[line];
  if (!data.exact) {
    const ChartTriangle& b = *candidates_[data.candidate].triangle;
    const auto points = texture_points<mpz_class>(b, units_), at = texture_points<mpz_class>(*a_, units_);
    data.exact = std::make_unique<ExactWeights>();
    for (std::size_t i = 0; i < 3; ++i) (*data.exact)[i] = line_at(b, points, data.number, at[i]);
  }
  return *data.exact;
}

Overlay::ExactWeights Overlay::exact(const Node& node) {
  ExactWeights weights;
  if (node.second == Node::is_corner) {
    weights[node.first] = 1;
    return weights;
  }
  if (node.second == Node::is_given) {
    int unit = no_bit;
    for (const double w : node.given) unit = std::min(unit, lowest_bit(w));
    for (std::size_t i = 0; i < 3; ++i) weights[i] = in_units(node.given[i], unit);
    return weights;
  }
  weights = cross_of_lines(exact(node.first), exact(node.second));
  if (sgn(sum(weights)) < 0) negate(weights);
  return weights;
}

Overlay::Node Overlay::crossing(Line line, Line other) {
  Node node;
  node.first = line;
  node.second = other;
  node.weights = cross_of_lines(lines_[line].at, lines_[other].at);
  for (const Eigen::Vector2d* end : lines_[line].ends)
    if (end != nullptr && is_end(lines_[other].ends, *end)) node.at = end;
  int sign = 0;
  if (!sign_is_known(sum(node.weights), sign))
    node.weights = near(exact(node));
  else if (sign < 0)
    negate(node.weights);
  return node;
}

bool Overlay::lies_on(const Node& node, const LineData& line) const {
  if (node.at != nullptr && is_end(line.ends, *node.at)) return true;
  if (node.second == Node::is_corner || node.second == Node::is_given) return false;
  for (const Line made_of : {node.first, node.second}) {
    const LineData& other = lines_[made_of];
    if (&other == &line) return true;
    if (other.ends[0] != nullptr && is_end(line.ends, *other.ends[0]) && is_end(line.ends, *other.ends[1])) return true;
  }
  return false;
}

int Overlay::side(Line line, const Node& node) {
  int sign = 0;
  if (sign_is_known(weighted(lines_[line].at, node.weights), sign)) return sign;
  if (lies_on(node, lines_[line])) return 0;
  return sgn(weighted(exact(line), exact(node)));
}

void Overlay::clip(const Polygon& polygon, Line line, bool flip, Polygon& result) {
  result.clear();
  sides_.clear();
  for (const PolygonCorner& corner : polygon)
    sides_.push_back(flip ? -side(line, corner.node) : side(line, corner.node));
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const int here = sides_[i], next = sides_[(i + 1) % polygon.size()];
    const Line to_next = polygon[i].to_next;
    if (here >= 0) result.push_back({polygon[i].node, here == 0 && next < 0 ? line : to_next});
    if (here > 0 && next < 0) result.push_back({crossing(to_next, line), line});
    if (here < 0 && next > 0) result.push_back({crossing(to_next, line), to_next});
  }
}

void Overlay::clip(Polygon& polygon, std::uint32_t candidate) {
  for (const Line line : lines_of(candidate)) {
    if (polygon.empty()) return;
    clip(polygon, line, false, clipped_);
    std::swap(polygon, clipped_);
  }
}

bool Overlay::covers(std::uint32_t candidate, const Node& node) {
  const auto lines = lines_of(candidate);
  return std::all_of(lines.begin(), lines.end(), [&](Line line) { return side(line, node) >= 0; });
}

Bounds Overlay::distance(std::uint32_t candidate, const Node& node, double precision) {
  const Candidate& c = candidates_[candidate];
  if (c.triangle->chart == Chart::Area) {
    const Bounds bounds = near_distance(c, node);
    if (bounds.upper - bounds.lower <= precision) return bounds;
  }
  return exact_distance(c, node);
}

Bounds Overlay::near_distance(const Candidate& candidate, const Node& node) const {
  const TexturedTriangle &a = *a_->source, &b = *candidate.triangle->source;
  Weights to;
  for (std::size_t k = 0; k < 3; ++k) to[k] = weighted(lines_[candidate.lines[k]].at, node.weights);
  const auto only = std::find_if(to.begin(), to.end(), [](const Approximate& w) { return !w.is_zero(); });
  const bool is_corner = only != to.end() && std::all_of(only + 1, to.end(), [](const auto& w) { return w.is_zero(); });
  if (is_corner && node.second == Node::is_corner)
    return distance_bounds(a.corners[node.first], b.corners[static_cast<std::size_t>(only - to.begin())]);
  std::array<Approximate, 3> offset;
  const Approximate from_sum = sum(node.weights), to_sum = sum(to);
  const Eigen::Vector3d origin = a.corners[0];
  for (std::size_t k = 0; k < 3; ++k) {
    const Approximate from_weight = node.weights[k] / from_sum, to_weight = to[k] / to_sum;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto axis = static_cast<Eigen::Index>(i);
      const Approximate from_way = Approximate{a.corners[k][axis], 0} - Approximate{origin[axis], 0};
      const Approximate to_way = Approximate{b.corners[k][axis], 0} - Approximate{origin[axis], 0};
      offset[i] = offset[i] + (from_weight * from_way - to_weight * to_way);
    }
  }
  return length_bounds(offset);
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

TextureWitness Overlay::witness(std::uint32_t candidate, const Node& node) {
  const Candidate& c = candidates_[candidate];
  const Fibre f = fibre(c, node);
  std::array<Eigen::Vector3d, 3> corners;
  for (std::size_t k = 0; k < 3; ++k)
    corners[k] = as_doubles(f.corners[std::min(k, f.corner_count - 1)], f.denominator, units_.position);
  TextureWitness witness;
  witness.from = {as_doubles(f.point, f.denominator, units_.position), a_->source->triangle};
  witness.nearest = {nearest_on(corners, witness.from.position), c.triangle->source->triangle};
  const std::array<double, 3> weights = rounded(node);
  for (std::size_t i = 0; i < 3; ++i) witness.coordinate += weights[i] * a_->source->coordinates[i];
  witness.distance = (witness.from.position - witness.nearest.position).norm();
  return witness;
}

std::array<double, 3> Overlay::rounded(const Node& node) {
  const double total = node.weights[0].value + node.weights[1].value + node.weights[2].value;
  std::array<double, 3> weights{};
  for (std::size_t i = 0; i < 3; ++i) weights[i] = std::max(0.0, node.weights[i].value / total);
  return weights;
}

Approximate Overlay::share(const Polygon& polygon) {
  Approximate total;
  if (polygon.size() < 3) return total;
  std::vector<std::array<Approximate, 2>> points;
  for (const PolygonCorner& corner : polygon) {
    Weights w = corner.node.weights;
    Approximate all = sum(w);
    if (!(std::fabs(all.value) > 0x1p20 * all.error)) {
      w = near(exact(corner.node));
      all = sum(w);
    }
    points.push_back({w[1] / all, w[2] / all});
  }
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    const auto &p = points[0], &q = points[i], &r = points[i + 1];
    total = total + ((q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]));
  }
  return total;
}

}  // namespace meshbound
