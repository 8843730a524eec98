// SPDX-License-Identifier: MIT
#include "texture/overlay.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "texture/overlay_numbers.h"

namespace meshbound {
namespace {

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

/// As `line_at`, with doubles.
Approximate near_line_at(const ChartTriangle& t, std::uint32_t number, const Eigen::Vector2d& at,
                         const ExactUnits& units) {
  if (t.chart == Chart::Area) {
    const auto& uv = t.source->coordinates;
    const Approximate area = doubled_area(uv[(number + 1) % 3], uv[(number + 2) % 3], at);
    return t.turned ? -area : area;
  }
  return line_at(t, texture_points<Approximate>(t, units), number, TexturePoint<Approximate>{{at.x(), 0}, {at.y(), 0}});
}

template <class Number>
std::array<Number, 3> cross_of_lines(const std::array<Number, 3>& p, const std::array<Number, 3>& q) {
  return {Number(Number(p[1] * q[2]) - Number(p[2] * q[1])), Number(Number(p[2] * q[0]) - Number(p[0] * q[2])),
          Number(Number(p[0] * q[1]) - Number(p[1] * q[0]))};
}

template <class Number>
void negate(std::array<Number, 3>& x) {
  for (Number& k : x) k = -k;
}

/// Weights whose sum is not this many times their error are made of integers: where lines hardly cross, their point may
/// be far from where doubles see it, and a cut that seems to halve a piece leaves all of it on one side.
constexpr double precise_enough = 0x1p20;

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

ChartTriangle chart_triangle(const TexturedTriangle& triangle, const ExactUnits& units) {
  ChartTriangle result;
  result.source = &triangle;
  const auto& uv = triangle.coordinates;
  int turn = 0;
  if (!sign_is_known(doubled_area(uv[0], uv[1], uv[2]), turn)) {
    const auto exact_points = texture_points<mpz_class>(result, units);
    turn = sgn(cross<mpz_class>(exact_points[1] - exact_points[0], exact_points[2] - exact_points[0]));
  }
  result.turned = turn < 0;
  if (turn != 0) {
    result.plane = LiftedPlane(triangle);
    return result;
  }
  std::sort(result.along.begin(), result.along.end(), [&](std::uint8_t p, std::uint8_t q) {
    return std::pair(uv[p].x(), uv[p].y()) < std::pair(uv[q].x(), uv[q].y());
  });
  result.chart = uv[result.along[0]] == uv[result.along[2]] ? Chart::Point : Chart::Segment;
  return result;
}

void Overlay::begin(const ChartTriangle& a) {
  a_ = &a;
  lines_.clear();
  exact_.clear();
  candidates_.clear();
  spanning_.clear();
  for (std::size_t i = 0; i < 3; ++i) {
    LineData line;
    line.at[i] = {1, 0};
    if (a.chart == Chart::Area) line.ends = edge_of(a, i);
    lines_.push_back(line);
  }
  whole_.resize(3);
  for (Line i = 0; i < 3; ++i) {
    Weights weights;
    weights[i] = {1, 0};
    whole_[i] = {{i, Node::is_corner, weights, &a.source->coordinates[i]}, (i + 2) % 3};
  }
}

void Overlay::add(const ChartTriangle& b) {
  const auto first = static_cast<Line>(lines_.size());
  const std::uint32_t line_count = b.chart == Chart::Area ? 3 : 4;
  for (std::uint32_t number = 0; number < line_count; ++number) {
    LineData& line = lines_.emplace_back();
    line.candidate = candidates();
    line.number = number;
    if (b.chart == Chart::Area) line.ends = edge_of(b, number);
    bool is_beyond = true;
    for (std::size_t i = 0; i < 3; ++i) {
      const Eigen::Vector2d& at = a_->source->coordinates[i];
      if (!is_end(line.ends, at)) line.at[i] = near_line_at(b, number, at, units_);
      is_beyond = is_beyond && line.at[i].value < -line.at[i].error;
    }
    if (is_beyond) {
      lines_.resize(first);
      return;
    }
  }
  if (a_->chart != Chart::Area || b.chart == Chart::Area) spanning_.push_back(candidates());
  if (b.number >= candidate_of_.size()) candidate_of_.resize(b.number + 1, 0);
  candidate_of_[b.number] = candidates();
  Candidate& candidate = candidates_.emplace_back();
  candidate.triangle = &b;
  candidate.lines = {first, first + 1, first + 2, first + 3};
  candidate.line_count = static_cast<std::uint8_t>(line_count);
}

std::optional<std::uint32_t> Overlay::number_of(const ChartTriangle& b) const {
  if (b.number >= candidate_of_.size()) return std::nullopt;
  const std::uint32_t candidate = candidate_of_[b.number];
  return candidate < candidates() && candidates_[candidate].triangle == &b ? std::optional(candidate) : std::nullopt;
}

Overlay::Line Overlay::add_level(std::size_t corner, std::int64_t numerator) {
  constexpr std::int64_t one = std::int64_t{1} << 40;
  Weights at;
  ExactWeights weights;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::int64_t value = (i == corner ? one : 0) - numerator;
    at[i] = {static_cast<double>(value), 0};
    weights[i] = static_cast<long>(value);
  }
  return add_line(at, std::move(weights));
}

Overlay::Line Overlay::add_cut(const std::array<double, 3>& at) {
  const double largest = std::max({std::fabs(at[0]), std::fabs(at[1]), std::fabs(at[2])});
  Weights rounded;
  ExactWeights weights;
  for (std::size_t i = 0; i < 3; ++i) {
    const double value = std::round(0x1p40 * (at[i] / largest));
    rounded[i] = {value, 0};
    weights[i] = value;
  }
  return add_line(rounded, std::move(weights));
}

/// Adds a line that belongs to no candidate.
Overlay::Line Overlay::add_line(const Weights& at, ExactWeights exact) {
  LineData& line = lines_.emplace_back();
  line.at = at;
  line.exact = &exact_.emplace_back(std::move(exact));
  return static_cast<Line>(lines_.size() - 1);
}

std::optional<Overlay::Line> Overlay::add_middle_coordinate(const Polygon& polygon) {
  const auto uv = texture_points<mpz_class>(*a_, units_);
  const auto &low = uv[a_->along[0]], way = uv[a_->along[2]] - low;
  ExactWeights along;  // by corner of A
  for (std::size_t i = 0; i < 3; ++i) along[i] = dot<mpz_class>(way, uv[i] - low);
  std::optional<mpq_class> first, last;
  for (const PolygonCorner& corner : polygon) {
    const ExactWeights weights = exact(corner.node);
    mpq_class at(weighted(along, weights), sum(weights));
    at.canonicalize();
    if (!first || at < *first) first = at;
    if (!last || at > *last) last = at;
  }
  const mpq_class width = *last - *first;
  if (sgn(width) == 0) return std::nullopt;
  // Rounded down to units of less than an eighth of the width.
  const std::size_t above = mpz_sizeinbase(width.get_num_mpz_t(), 2), below = mpz_sizeinbase(width.get_den_mpz_t(), 2);
  const std::size_t bits = below + 4 > above ? below + 4 - above : 0;
  const mpq_class twice = *first + *last;
  const mpz_class level = (twice.get_num() << bits) / (2 * twice.get_den());
  ExactWeights weights;
  for (std::size_t i = 0; i < 3; ++i) weights[i] = (along[i] << bits) - level;
  const Weights at = near(weights);  // before they are moved
  return add_line(at, std::move(weights));
}

std::span<const Overlay::Line> Overlay::lines_of(std::uint32_t candidate) const {
  const Candidate& c = candidates_[candidate];
  return std::span(c.lines).first(c.line_count);
}

Overlay::Node Overlay::corner_of(std::uint32_t candidate, std::size_t corner) {
  const std::array<Line, 4>& lines = candidates_[candidate].lines;
  return crossing(lines[(corner + 1) % 3], lines[(corner + 2) % 3]);
}

Overlay::Node Overlay::given(const std::array<double, 3>& weights) {
  Node node;
  node.second = Node::is_given;
  for (std::size_t i = 0; i < 3; ++i) node.weights[i] = {weights[i], 0};
  return node;
}

/// Sums the weights of all corners, scaled to totals with the same number of bits.
Overlay::Node Overlay::inside(const Polygon& polygon, const Node& corner, int closer) {
  std::vector<ExactWeights> corners;
  std::vector<std::size_t> bits;
  for (const PolygonCorner& c : polygon) {
    corners.push_back(exact(c.node));
    const mpz_class total = sum(corners.back());
    bits.push_back(mpz_sizeinbase(total.get_mpz_t(), 2));
  }
  const std::size_t max_bits = *std::max_element(bits.begin(), bits.end());
  ExactWeights weights;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const std::size_t up = max_bits - bits[k] + (&polygon[k].node == &corner ? static_cast<std::size_t>(closer) : 0);
    for (std::size_t i = 0; i < 3; ++i) weights[i] += corners[k][i] << up;
  }
  Node node;
  node.first = static_cast<Line>(exact_.size());
  node.second = Node::is_exact;
  node.weights = near(weights);
  exact_.push_back(std::move(weights));
  return node;
}

const Overlay::ExactWeights& Overlay::exact(Line line) {
  LineData& data = lines_[line];
  if (data.exact != nullptr) return *data.exact;
  ExactWeights& weights = exact_.emplace_back();
  data.exact = &weights;
  if (line < 3) {
    weights[line] = 1;
    return weights;
  }
  const ChartTriangle& b = *candidates_[data.candidate].triangle;
  const auto points = texture_points<mpz_class>(b, units_), at = texture_points<mpz_class>(*a_, units_);
  for (std::size_t i = 0; i < 3; ++i) weights[i] = line_at(b, points, data.number, at[i]);
  return weights;
}

Overlay::ExactWeights Overlay::exact(const Node& node) {
  ExactWeights weights;
  if (node.second == Node::is_corner) {
    weights[node.first] = 1;
    return weights;
  }
  if (node.second == Node::is_exact) return exact_[node.first];
  if (node.second == Node::is_given) {
    int unit = no_bit;
    for (const Approximate& w : node.weights) unit = std::min(unit, lowest_bit(w.value));
    for (std::size_t i = 0; i < 3; ++i) weights[i] = in_units(node.weights[i].value, unit);
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
  const Approximate total = sum(node.weights);
  const double error = node.weights[0].error + node.weights[1].error + node.weights[2].error;
  if (!(std::fabs(total.value) > precise_enough * error))
    node.weights = near(exact(node));
  else if (total.value < 0)
    negate(node.weights);
  return node;
}

bool Overlay::lies_on(const Node& node, const LineData& line) const {
  if (node.at != nullptr && is_end(line.ends, *node.at)) return true;
  if (node.second >= Node::is_exact) return false;
  for (const Line made_of : {node.first, node.second}) {
    const LineData& other = lines_[made_of];
    if (&other == &line) return true;
    if (other.ends[0] != nullptr && is_end(line.ends, *other.ends[0]) && is_end(line.ends, *other.ends[1])) return true;
  }
  return false;
}

int Overlay::side(Line line, const Node& node) {
  int sign = 0;
  const bool is_corner = node.second == Node::is_corner;
  const Approximate at = is_corner ? lines_[line].at[node.first] : weighted(lines_[line].at, node.weights);
  if (sign_is_known(at, sign)) return sign;
  if (lies_on(node, lines_[line])) return 0;
  return sgn(weighted(exact(line), exact(node)));
}

bool Overlay::is_on_one_side(Line line, const Polygon& polygon) {
  bool has_inside = false, has_outside = false;
  for (const PolygonCorner& corner : polygon) {
    const int here = side(line, corner.node);
    has_inside = has_inside || here > 0;
    has_outside = has_outside || here < 0;
    if (has_inside && has_outside) return false;
  }
  return true;
}

int Overlay::inner_side(Line line, const Polygon& polygon) {
  for (const PolygonCorner& corner : polygon)
    if (const int here = side(line, corner.node); here != 0) return here;
  return 0;
}

bool Overlay::is_inside(const Polygon& polygon, const Node& node) {
  return std::all_of(polygon.begin(), polygon.end(), [&](const PolygonCorner& corner) {
    const int inner = inner_side(corner.to_next, polygon);
    return inner != 0 && side(corner.to_next, node) == inner;
  });
}

void Overlay::set_sides(const Polygon& polygon, Line line) {
  sides_.clear();
  for (const PolygonCorner& corner : polygon) sides_.push_back(side(line, corner.node));
}

/// Keeps what lies on the positive side of the line, or on it.
void Overlay::cut_by_sides(const Polygon& polygon, Line line, Polygon& result) {
  result.clear();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const int here = sides_[i], next = sides_[(i + 1) % polygon.size()];
    const Line to_next = polygon[i].to_next;
    if (here >= 0) result.push_back({polygon[i].node, here == 0 && next < 0 ? line : to_next});
    if (here > 0 && next < 0) result.push_back({crossing(to_next, line), line});
    if (here < 0 && next > 0) result.push_back({crossing(to_next, line), to_next});
  }
}

void Overlay::clip(const Polygon& polygon, Line line, bool flip, Polygon& result) {
  set_sides(polygon, line);
  if (flip)
    for (int& side : sides_) side = -side;
  cut_by_sides(polygon, line, result);
}

void Overlay::clip(const Polygon& polygon, std::uint32_t candidate, Polygon& result) {
  const Polygon* rest = &polygon;
  for (const Line line : lines_of(candidate)) {
    set_sides(*rest, line);
    if (std::none_of(sides_.begin(), sides_.end(), [](int side) { return side < 0; })) continue;
    cut_by_sides(*rest, line, clipped_);
    std::swap(result, clipped_);
    rest = &result;
  }
  if (rest != &result) result = polygon;
}

bool Overlay::covers(std::uint32_t candidate, const Node& node) {
  const auto lines = lines_of(candidate);
  return std::all_of(lines.begin(), lines.end(), [&](Line line) { return side(line, node) >= 0; });
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
