// SPDX-License-Identifier: MIT
#include "simplify/texture/texture_guard.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/point_triangle.h"
#include "numeric/no_index.h"
#include "simplify/texture/nearest_with_coordinate.h"
#include "simplify/texture/weighted_points.h"

namespace meshbound {
namespace {

/// Share of the limit: a coordinate whose worst sample is below it needs no improvement, nor does a match in a palette.
constexpr double good_share = 0.5;
/// In multiples of the limit: where a sample is farther away than this, no coordinate of the vertex helps.
constexpr double hopeful_share = 4;
/// Share of the limit: a vertex so near an end of the edge takes the coordinates of that end. Placements often miss it
/// by what rounding makes of them, and the largest coordinate of a scalar field must not be lost by that.
constexpr double share_at_end = 1e-6;
/// Most Newton steps for one coordinate; a step without gain ends them earlier.
constexpr int max_steps = 4;
/// Steps gain less and less: those still to come are taken for this share of the last one, and where that would not
/// reach the limit there are none. 0.2% more faces in 0.95 of the time (four models at three tolerances).
constexpr double gain_of_next_steps = 0.5;
/// Samples that are looked at first where a star has more than twice as many: where no coordinate of the vertex brings
/// these within the limit, none does for all.
constexpr std::size_t few_samples = 32;

/// Smallest barycentric coordinate with which a sample counts as inside a face: slightly negative, as it may lie on the
/// edge.
constexpr double min_weight = -1e-9;

/// Weights of the point on the outline of a triangle in the texture that is closest to `p`, and its squared distance.
std::array<double, 3> closest_on_outline(const CornerCoordinates& t, const Eigen::Vector2d& p, double& squared) {
  std::array<double, 3> best{};
  squared = HUGE_VAL;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    const double share = closest_share(t[k], t[next], p);
    const double here = (t[k] + share * (t[next] - t[k]) - p).squaredNorm();
    if (!(here < squared)) continue;
    squared = here;
    best = {};
    best[k] = 1 - share;
    best[next] = share;
  }
  return best;
}

/// The squared distance in the texture from a sample to the point of a face that is nearest there, and in space to that
/// point: of a line in the texture many faces may have the coordinate of a sample, but one is where it is.
std::pair<double, double> squared_distances(const TextureMap::Sample& sample, const TriangleCorners& at,
                                            const CornerCoordinates& t) {
  std::optional<Vec3> point;
  const auto weights = weights_at(t, sample.coordinate);
  if (!weights)
    point = nearest_with_coordinate(at, t, sample.coordinate, sample.at);
  else if (std::none_of(weights->begin(), weights->end(), [](double w) { return w < 0; }))
    point = point_of(at, *weights);
  double squared = 0;
  if (!point) point = point_of(at, closest_on_outline(t, sample.coordinate, squared));
  return {squared, squared_length(*point - sample.at)};
}

}  // namespace

void TextureGuard::begin(const TexturedStar& star) {
  star_ = star;
  accepted_ = false;
  samples_.clear();
  charts_.clear();
  faces_.clear();
  matches_.clear();
  area_before_.clear();
  const auto add_samples = [&](std::uint32_t face, std::uint32_t first_guess) {
    map_.lists.for_each(face, [&](std::uint32_t s) {
      __builtin_prefetch(&map_.sample(s));
      samples_.push_back(s);
      charts_.push_back(map_.chart(face));
      Match& match = matches_.emplace_back();
      match.face = first_guess;
      match.is_inside = first_guess != no_index;
    });
  };
  for (const Corner c : star.moved) {
    const std::uint32_t f = c / 3;
    add_samples(f, static_cast<std::uint32_t>(faces_.size()));
    Face& face = faces_.emplace_back();
    const std::array<Corner, 3> corners = {c, next_corner(c), previous_corner(c)};
    for (std::size_t k = 0; k < 3; ++k) {
      face.at[k] = mesh_.position(mesh_.start(corners[k]));
      face.coordinates[k] = map_.at(corners[k]);
    }
    face.chart = map_.chart(f);
    face.number = f;
    area_before_.push_back(doubled_area(face.coordinates));
  }
  for (const std::uint32_t f : star.removed) add_samples(f, no_index);
  put_few_first();
}

/// Puts few samples from all over the star before the others.
void TextureGuard::put_few_first() {
  if (!has_many()) return;
  for (std::size_t i = 0; i < few_samples; ++i) {
    const std::size_t from = i * samples_.size() / few_samples;
    std::swap(samples_[i], samples_[from]);
    std::swap(charts_[i], charts_[from]);
    std::swap(matches_[i], matches_[from]);
  }
}

bool TextureGuard::has_many() const { return samples_.size() > 2 * few_samples; }

/// Gives a coordinate to the corners of the removed vertex on one side of its line: those that are connected with
/// corner `of_leaving` without crossing a line.
void TextureGuard::set_sector(Corner of_leaving, const Eigen::Vector2d& coordinate) {
  const auto set = [&](Corner c) {
    for (std::size_t i = 0; i < faces_.size(); ++i)
      if (star_.moved[i] == c) faces_[i].coordinates[0] = coordinate;
  };
  const std::uint32_t edge = mesh_.edge(star_.edge);
  for (Corner c = of_leaving; mesh_.edge(c) != edge && !lines_.is_line(mesh_, c);) {
    c = next_corner(mesh_.twin(c));
    if (c == of_leaving) break;
    set(c);
  }
  for (Corner c = previous_corner(of_leaving); mesh_.edge(c) != edge && !lines_.is_line(mesh_, c);) {
    const Corner next = mesh_.twin(c);
    if (next == of_leaving) break;
    set(next);
    c = previous_corner(next);
  }
}

void TextureGuard::set_at_end(std::uint32_t stays, std::uint32_t leaves) {
  for (const std::uint32_t f : star_.removed) {
    Corner staying = 0, leaving = 0;
    for (Corner c = 3 * f; c < 3 * f + 3; ++c) {
      if (mesh_.start(c) == stays) staying = c;
      if (mesh_.start(c) == leaves) leaving = c;
    }
    set_sector(leaving, map_.at(staying));
  }
}

/// The coordinate of the closest point of the faces around, in their state before the collapse.
std::optional<Eigen::Vector2d> TextureGuard::coordinate_at(Vec3 point) const {
  double least = HUGE_VAL;
  std::optional<Eigen::Vector2d> result;
  const auto visit = [&](std::uint32_t face) {
    if (map_.chart(face) == no_index) return;
    const auto corners = mesh_.triangle(face);
    const Vec3 u = corners[1] - corners[0], v = corners[2] - corners[0];
    const Vec3 offset = closest_on_triangle(CornerTriangle<double>{corners[0], u, v}, point).offset;
    const double squared = squared_length(offset);
    if (!(squared < least)) return;
    least = squared;
    const Vec3 w = point - offset - corners[0];  // in the plane of the face
    const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), uw = dot(u, w), vw = dot(v, w);
    const double determinant = uu * vv - uv * uv;
    if (!(determinant > 0)) return;
    const double second = (vv * uw - uv * vw) / determinant, third = (uu * vw - uv * uw) / determinant;
    const CornerCoordinates t = map_.of(face);
    result = t[0] + second * (t[1] - t[0]) + third * (t[2] - t[0]);
  };
  for (const Corner c : star_.moved) visit(c / 3);
  for (const std::uint32_t f : star_.removed) visit(f);
  return result;
}

void TextureGuard::move_to(const Eigen::Vector2d& coordinate) {
  for (Face& face : faces_) face.coordinates[0] = coordinate;
}

bool TextureGuard::set_faces(Vec3 point) {
  for (std::size_t i = 0; i < faces_.size(); ++i) {
    faces_[i].at[0] = point;
    faces_[i].coordinates[0] = map_.at(star_.moved[i]);
  }
  const std::uint32_t start = mesh_.start(star_.edge), end = mesh_.end(star_.edge);
  const auto is_at = [&](std::uint32_t v) {
    return squared_length(point - mesh_.position(v)) <= share_at_end * share_at_end * map_.limit * map_.limit;
  };
  const bool is_at_start = is_at(start), is_at_end = is_at(end);
  is_free_ = !is_at_start && !is_at_end;
  if (is_at_start && !(is_at_end && lines_.at(start) == no_index)) {
    set_at_end(start, end);
  } else if (is_at_end) {
    set_at_end(end, start);
  } else {
    const auto coordinate = coordinate_at(point);
    if (!coordinate) return false;
    move_to(*coordinate);
  }
  return true;
}

/// Whether a face would cover its part of the texture with the opposite orientation, or none of it.
bool TextureGuard::is_turned_over() const {
  for (std::size_t i = 0; i < faces_.size(); ++i) {
    if (faces_[i].chart == no_index || area_before_[i] == 0) continue;
    if (!(doubled_area(faces_[i].coordinates) * area_before_[i] > 0)) return true;
  }
  return false;
}

/// Sets `match` to the point of a face with the coordinate of the sample. False if it has none.
bool TextureGuard::match_inside(const TextureMap::Sample& sample, std::uint32_t number, Match& match) const {
  const Face& face = faces_[number];
  match.face = number;
  match.is_inside = true;
  if (!face.has_area) {
    const std::optional<Vec3> nearest = face.line.nearest(face.at, sample.coordinate, sample.at);
    match.weights = {1, 0, 0};
    if (nearest) match.offset = *nearest - sample.at;
    return nearest.has_value();
  }
  const Eigen::Vector2d weights = face.to_weights * (sample.coordinate - face.coordinates[0]);
  match.weights = {1 - weights.x() - weights.y(), weights.x(), weights.y()};
  if (std::min({match.weights[0], match.weights[1], match.weights[2]}) < min_weight) return false;
  match.offset = point_of(face.at, match.weights) - sample.at;
  return true;
}

/// Whether no other face needs to be looked at: in charts with an area hardly one has the coordinate as well. Where all
/// of the faces have one coordinate, one that is near enough will do.
bool TextureGuard::suffices(const Match& match) const {
  const Face& face = faces_[match.face];
  const double near = good_share * map_.limit;
  return face.has_area || (face.has_one_coordinate && squared_length(match.offset) <= near * near);
}

/// Whether the face that a sample was matched with last suffices again.
bool TextureGuard::matches_again(const TextureMap::Sample& sample, Match& match) const {
  if (!match.is_inside) return false;
  const Face& face = faces_[match.face];
  return (face.has_area || face.has_one_coordinate) && match_inside(sample, match.face, match) && suffices(match);
}

TextureGuard::Match TextureGuard::match(const TextureMap::Sample& sample, std::uint32_t chart) const {
  Match match, nearest;
  for (std::uint32_t i = 0; i < faces_.size(); ++i) {
    if (faces_[i].chart != chart || !match_inside(sample, i, match)) continue;
    if (suffices(match)) return match;
    if (nearest.face == no_index || squared_length(match.offset) < squared_length(nearest.offset)) nearest = match;
  }
  return nearest.face == no_index ? match_outside(sample, chart) : nearest;
}

/// The point of the faces that is nearest in the texture to a sample whose coordinate no face has.
TextureGuard::Match TextureGuard::match_outside(const TextureMap::Sample& sample, std::uint32_t chart) const {
  Match best;
  double least = HUGE_VAL;
  for (std::uint32_t i = 0; i < faces_.size(); ++i) {
    if (faces_[i].chart != chart) continue;
    double squared = 0;
    const std::array<double, 3> weights = closest_on_outline(faces_[i].coordinates, sample.coordinate, squared);
    if (!(squared < least)) continue;
    least = squared;
    best = {i, false, weights, point_of(faces_[i].at, weights) - sample.at};
  }
  return best;
}

void TextureGuard::prepare_faces() {
  for (Face& face : faces_) {
    Eigen::Matrix2d sides;
    sides << face.coordinates[1] - face.coordinates[0], face.coordinates[2] - face.coordinates[0];
    face.has_area = sides.determinant() != 0;
    face.has_one_coordinate = face.coordinates[0] == face.coordinates[1] && face.coordinates[0] == face.coordinates[2];
    if (!face.has_area) {
      face.line = LineCoordinates(face.coordinates);
      continue;
    }
    face.to_weights = sides.inverse();
    const double by_limit = 1 / map_.limit;
    const Vec3 u = by_limit * (face.at[1] - face.at[0]), v = by_limit * (face.at[2] - face.at[0]);
    face.derivative[0] = face.to_weights(0, 0) * u + face.to_weights(1, 0) * v;
    face.derivative[1] = face.to_weights(0, 1) * u + face.to_weights(1, 1) * v;
    const auto& [by_u, by_v] = face.derivative;
    face.squared_derivative = {dot(by_u, by_u), dot(by_u, by_v), dot(by_v, by_v)};
  }
}

/// Finds a face for each of the first samples: the one of the last call, at first the one before the collapse, where it
/// still has the coordinate of the sample. False if a sample has none, or none within `max_squared`.
bool TextureGuard::match(std::size_t count, double max_squared) {
  prepare_faces();
  for (std::size_t i = 0; i < count; ++i) {
    const TextureMap::Sample& sample = map_.sample(samples_[i]);
    Match& match = matches_[i];
    if (!matches_again(sample, match)) match = this->match(sample, charts_[i]);
    const double squared = match.face == no_index ? HUGE_VAL : squared_length(match.offset);
    if (squared <= max_squared) continue;
    exceeding_squared_ = squared;
    return false;
  }
  return true;
}

/// Derivative of a sample's distance by the coordinate of the vertex: where the vertex moves by d in the texture, the
/// point of the face with the sample's coordinate moves by -weight J d, with J the derivative of the position in the
/// face by the coordinate.
void TextureGuard::add_slope(const Face& face, const Match& match, Slope& sum) const {
  if (!face.has_area || !match.is_inside) return;
  const double weight = match.weights[0];
  const Vec3 offset = (1 / map_.limit) * match.offset;
  const double squared = squared_length(offset);
  // The objective is the sum of squared^3: its gradient is 6 squared^2 D^T e; of its Hessian only the positive
  // semidefinite part is kept.
  const double slope_u = -weight * dot(face.derivative[0], offset), slope_v = -weight * dot(face.derivative[1], offset);
  const double first = 6 * squared * squared, second = 24 * squared;
  sum.gradient[0] += first * slope_u;
  sum.gradient[1] += first * slope_v;
  const double of_face = first * weight * weight;
  sum.curvature[0] += of_face * face.squared_derivative[0] + second * slope_u * slope_u;
  sum.curvature[1] += of_face * face.squared_derivative[1] + second * slope_u * slope_v;
  sum.curvature[2] += of_face * face.squared_derivative[2] + second * slope_v * slope_v;
}

/// The Newton step of the coordinate of the vertex; nothing where the curvature is singular.
std::optional<Eigen::Vector2d> TextureGuard::newton_step(std::size_t count) const {
  Slope sum;
  for (const Match& m : std::span(matches_).first(count)) add_slope(faces_[m.face], m, sum);
  const auto& [uu, uv, vv] = sum.curvature;
  const double determinant = uu * vv - uv * uv;
  if (!(determinant > 0)) return std::nullopt;
  const Eigen::Vector2d step((uv * sum.gradient[1] - vv * sum.gradient[0]) / determinant,
                             (uv * sum.gradient[0] - uu * sum.gradient[1]) / determinant);
  return step.allFinite() ? std::optional(step) : std::nullopt;
}

double TextureGuard::worst_squared(std::size_t count) const {
  double worst = 0;
  for (const Match& m : std::span(matches_).first(count)) worst = std::max(worst, squared_length(m.offset));
  return worst;
}

/// Moves the coordinate of the vertex until the first samples are within the limit or no step helps. Leaves the faces
/// with the best coordinate.
bool TextureGuard::improve(std::size_t count) {
  const double limit = map_.limit * map_.limit, good = good_share * good_share * limit;
  double worst = worst_squared(count);
  for (int k = 0; is_free_ && worst > good && k < max_steps; ++k) {
    const std::optional<Eigen::Vector2d> step = newton_step(count);
    if (!step) break;
    const Eigen::Vector2d before = faces_[0].coordinates[0];
    matches_before_.assign(matches_.begin(), matches_.begin() + static_cast<std::ptrdiff_t>(count));
    move_to(before + *step);
    const bool is_possible = !is_turned_over() && match(count, worst);
    const double there = is_possible ? worst_squared(count) : HUGE_VAL;
    if (!(there < worst)) {
      move_to(before);
      std::copy(matches_before_.begin(), matches_before_.end(), matches_.begin());
      break;
    }
    const double gain = std::sqrt(worst) - std::sqrt(there);
    worst = there;
    if (std::sqrt(worst) - gain_of_next_steps * (max_steps - 1 - k) * gain > map_.limit) break;
  }
  exceeding_squared_ = worst > limit ? worst : 0;
  return worst <= limit;
}

/// Whether the first samples are near the faces, with the coordinate of the vertex where it is or at a better place.
bool TextureGuard::are_near(std::size_t count) {
  const double reach = (is_free_ ? hopeful_share : 1) * map_.limit;
  return match(count, reach * reach) && improve(count);
}

bool TextureGuard::holds(Vec3 point) {
  accepted_ = false;
  exceeding_squared_ = 0;
  const bool is_bare = std::all_of(faces_.begin(), faces_.end(), [](const Face& f) { return f.chart == no_index; });
  if (is_bare) return true;
  if (!set_faces(point) || is_turned_over()) return false;
  if (has_many() && !are_near(few_samples)) return false;
  if (!are_near(samples_.size())) return false;
  if (!are_uncovered_free() || !are_borders_free() || !are_faces_near()) return false;
  accepted_ = true;
  return true;
}

void TextureGuard::apply(TextureMap& map) const {
  if (!accepted_) return;
  for (std::size_t i = 0; i < faces_.size(); ++i) map.set(star_.moved[i], faces_[i].coordinates[0]);
}

void TextureGuard::give_samples(TextureMap& map) const {
  if (!accepted_) return;
  for (const Face& face : faces_) map.lists.clear(face.number);
  for (const std::uint32_t f : star_.removed) map.lists.clear(f);
  for (std::size_t i = 0; i < samples_.size(); ++i) map.lists.give_to(samples_[i], faces_[matches_[i].face].number);
}

void give_back_samples(TextureMap& map, const ArrayMesh& mesh, std::span<const std::uint32_t> faces) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> samples;  // each with its chart
  for (const std::uint32_t f : faces) {
    map.lists.for_each(f, [&](std::uint32_t s) { samples.emplace_back(s, map.chart(f)); });
    map.lists.clear(f);
  }
  for (const auto& [s, chart] : samples) {
    const TextureMap::Sample& sample = map.sample(s);
    std::pair<double, double> least{HUGE_VAL, HUGE_VAL};
    std::uint32_t best = no_index;
    for (const std::uint32_t f : faces) {
      if (mesh.is_removed(f) || map.chart(f) != chart) continue;
      const std::pair<double, double> distances = squared_distances(sample, mesh.triangle(f), map.of(f));
      if (best == no_index || distances < least) least = distances, best = f;
    }
    map.lists.give_to(s, best);
  }
}

}  // namespace meshbound
