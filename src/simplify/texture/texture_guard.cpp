// SPDX-License-Identifier: MIT
#include "simplify/texture/texture_guard.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/point_triangle.h"
#include "numeric/no_index.h"
#include "simplify/cover/face_box.h"

namespace meshbound {
namespace {

/// Share of the limit: a coordinate whose worst sample is below it needs no improvement.
constexpr double good_share = 0.5;
/// In multiples of the limit: where a sample is farther away than this, no coordinate of the vertex helps.
constexpr double hopeful_share = 4;
/// Most Newton steps for one coordinate; a step without gain ends them earlier.
constexpr int max_steps = 4;
/// Samples that are looked at first where a star has more than twice as many: where no coordinate of the vertex brings
/// these within the limit, none does for all.
constexpr std::size_t few_samples = 32;
/// The strip between a line of the original and the line that a collapse makes of it, in the texture, is sampled at
/// these shares of the way across.
constexpr std::array<double, 3> shares_of_strip = {0.02, 0.5, 0.98};

/// Points of a face that are compared with the original, by their weights; the first weight is that of the moving
/// vertex. The third edge of a face is the first one of the next face, or a line.
constexpr std::array<std::array<double, 3>, 5> tested_points = {
    {{1, 0, 0}, {0.75, 0.25, 0}, {0.5, 0.5, 0}, {0.25, 0.75, 0}, {1.0 / 3, 1.0 / 3, 1.0 / 3}}};

/// An edge that becomes a line is compared at the ends of this many parts.
constexpr int parts_of_line = 8;

/// Smallest barycentric coordinate with which a sample counts as inside a face: slightly negative, as it may lie on the
/// edge.
constexpr double min_weight = -1e-9;

double doubled_area(const CornerCoordinates& t) {
  const Eigen::Vector2d u = t[1] - t[0], v = t[2] - t[0];
  return u.x() * v.y() - u.y() * v.x();
}

Vec3 point_of(const std::array<Vec3, 3>& corners, const std::array<double, 3>& weights) {
  return weights[0] * corners[0] + weights[1] * corners[1] + weights[2] * corners[2];
}

/// Position of the point of segment ab closest to p, as a share of the way from a to b.
double closest_share(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& p) {
  const Eigen::Vector2d way = b - a;
  const double squared = way.squaredNorm();
  return squared > 0 ? std::clamp((p - a).dot(way) / squared, 0.0, 1.0) : 0;
}

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

}  // namespace

void TextureGuard::begin(const TexturedStar& star) {
  star_ = star;
  accepted_ = false;
  samples_.clear();
  charts_.clear();
  faces_.clear();
  matches_.clear();
  area_before_.clear();
  const auto add_samples = [&](std::uint32_t face, const Match& first_guess) {
    map_.lists.for_each(face, [&](std::uint32_t s) {
      samples_.push_back(s);
      charts_.push_back(map_.chart(face));
      matches_.push_back(first_guess);
    });
  };
  for (const Corner c : star.moved) {
    const std::uint32_t f = c / 3;
    add_samples(f, {static_cast<std::uint32_t>(faces_.size()), true, {}, {}});
    faces_.push_back({{mesh_.position(mesh_.start(c)), mesh_.position(mesh_.end(c)), mesh_.position(mesh_.apex(c))},
                      {map_.at(c), map_.at(next_corner(c)), map_.at(previous_corner(c))},
                      map_.chart(f),
                      f,
                      Eigen::Matrix2d::Zero(),
                      Eigen::Matrix<double, 3, 2>::Zero(),
                      Eigen::Matrix2d::Zero(),
                      false});
    area_before_.push_back(doubled_area(faces_.back().coordinates));
  }
  for (const std::uint32_t f : star.removed) add_samples(f, {});
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
  const bool is_at_start = squared_length(point - mesh_.position(start)) == 0;
  const bool is_at_end = squared_length(point - mesh_.position(end)) == 0;
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

/// The point of a face with the coordinate of the sample, if it has one.
std::optional<TextureGuard::Match> TextureGuard::match_inside(const TextureMap::Sample& sample,
                                                              std::uint32_t number) const {
  const Face& face = faces_[number];
  Match match{number, true, {1, 0, 0}, {}};
  if (!face.has_area) {  // one coordinate or a line of them: the nearest point stands for it
    const CornerTriangle<double> t{face.at[0], face.at[1] - face.at[0], face.at[2] - face.at[0]};
    match.offset = -1.0 * closest_on_triangle(t, sample.at).offset;
    return match;
  }
  const Eigen::Vector2d weights = face.to_weights * (sample.coordinate - face.coordinates[0]);
  match.weights = {1 - weights.x() - weights.y(), weights.x(), weights.y()};
  if (std::min({match.weights[0], match.weights[1], match.weights[2]}) < min_weight) return std::nullopt;
  match.offset = point_of(face.at, match.weights) - sample.at;
  return match;
}

TextureGuard::Match TextureGuard::match(const TextureMap::Sample& sample, std::uint32_t chart) const {
  Match best;
  for (std::uint32_t i = 0; i < faces_.size(); ++i) {
    if (faces_[i].chart != chart) continue;
    const auto here = match_inside(sample, i);
    if (here && (!best.is_inside || squared_length(here->offset) < squared_length(best.offset))) best = *here;
  }
  return best.is_inside ? best : match_outside(sample, chart);
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
    if (!face.has_area) continue;
    face.to_weights = sides.inverse();
    Eigen::Matrix<double, 3, 2> sides_in_space;
    sides_in_space << to_eigen(face.at[1] - face.at[0]), to_eigen(face.at[2] - face.at[0]);
    face.derivative = (1 / map_.limit) * sides_in_space * face.to_weights;
    face.squared_derivative = face.derivative.transpose() * face.derivative;
  }
}

/// Finds a face for each of the first samples: the one of the last call, at first the one before the collapse, where it
/// still has the coordinate of the sample. False if a sample has none, or none within `max_squared`.
bool TextureGuard::match(std::size_t count, double max_squared) {
  prepare_faces();
  for (std::size_t i = 0; i < count; ++i) {
    const TextureMap::Sample& sample = map_.sample(samples_[i]);
    Match& match = matches_[i];
    const auto again = match.is_inside ? match_inside(sample, match.face) : std::nullopt;
    match = again ? *again : this->match(sample, charts_[i]);
    if (match.face == no_index || !(squared_length(match.offset) <= max_squared)) return false;
  }
  return true;
}

/// Derivative of a sample's distance by the coordinate of the vertex: where the vertex moves by d in the texture, the
/// point of the face with the sample's coordinate moves by -weight J d, with J the derivative of the position in the
/// face by the coordinate.
void TextureGuard::add_slope(const Face& face, const Match& match, Slope& sum) const {
  if (!face.has_area || !match.is_inside) return;
  const double weight = match.weights[0];
  const Eigen::Vector3d offset = to_eigen((1 / map_.limit) * match.offset);
  const double squared = offset.squaredNorm();
  // The objective is the sum of squared^3: its gradient is 6 squared^2 D^T e; of its Hessian only the positive
  // semidefinite part is kept.
  const Eigen::Vector2d slope = -weight * (face.derivative.transpose() * offset);
  sum.gradient += 6 * squared * squared * slope;
  sum.curvature +=
      6 * squared * squared * weight * weight * face.squared_derivative + 24 * squared * slope * slope.transpose();
}

/// The Newton step of the coordinate of the vertex; nothing where the curvature is singular.
std::optional<Eigen::Vector2d> TextureGuard::newton_step(std::size_t count) const {
  Slope sum;
  for (const Match& m : std::span(matches_).first(count)) add_slope(faces_[m.face], m, sum);
  if (!(sum.curvature.determinant() > 0)) return std::nullopt;
  const Eigen::Vector2d step = -sum.curvature.inverse() * sum.gradient;
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
    worst = there;
  }
  return worst <= limit;
}

/// Whether edge k of a face that stays (edge 1 is opposite to the vertex) is a line, or becomes one by merging with the
/// line of a removed face.
bool TextureGuard::becomes_line(std::size_t face, std::size_t k) const {
  const Corner c = star_.moved[face];
  const Corner edge = k == 0 ? c : k == 1 ? next_corner(c) : previous_corner(c);
  if (lines_.is_line(mesh_, edge)) return true;
  const Corner across = mesh_.twin(edge);
  if (std::find(star_.removed.begin(), star_.removed.end(), across / 3) == star_.removed.end()) return false;
  const auto is_other_line = [&](Corner other) {
    return mesh_.edge(other) != mesh_.edge(star_.edge) && lines_.is_line(mesh_, other);
  };
  return is_other_line(next_corner(across)) || is_other_line(previous_corner(across));
}

/// Whether no point of the original whose coordinate lies in the strip between its line and that of the faces, in the
/// texture, is farther away than the limit: the result would show that texture at the line, or lack it there.
bool TextureGuard::is_border_free(std::size_t i) {
  const TextureMap::Sample& sample = map_.sample(samples_[i]);
  double least = HUGE_VAL;
  Eigen::Vector2d nearest = sample.coordinate;
  std::uint32_t material = 0;
  const auto visit = [&](const CornerCoordinates& t, std::size_t k, std::uint32_t face) {
    const std::size_t next = (k + 1) % 3;
    const Eigen::Vector2d p = t[k] + closest_share(t[k], t[next], sample.coordinate) * (t[next] - t[k]);
    if (!((p - sample.coordinate).squaredNorm() < least)) return;
    least = (p - sample.coordinate).squaredNorm();
    nearest = p;
    material = map_.material(face);
  };
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    if (faces_[f].chart != charts_[i]) continue;
    for (std::size_t k = 0; k < 3; ++k)
      if (becomes_line(f, k)) visit(faces_[f].coordinates, k, faces_[f].number);
  }
  return least == 0 || least == HUGE_VAL || is_strip_free(sample, nearest, material);
}

bool TextureGuard::is_strip_free(const TextureMap::Sample& sample, const Eigen::Vector2d& nearest,
                                 std::uint32_t material) {
  return std::none_of(shares_of_strip.begin(), shares_of_strip.end(), [&](double share) {
    const Eigen::Vector2d between = sample.coordinate + share * (nearest - sample.coordinate);
    return map_.atlas().has_far_point(between, material, sample.at, map_.limit, found_);
  });
}

bool TextureGuard::are_borders_free() {
  if (!lines_.is_line(mesh_, star_.edge)) return true;
  for (std::size_t i = 0; i < samples_.size(); ++i)
    if (map_.sample(samples_[i]).is_on_line && !is_border_free(i)) return false;
  return are_lines_near();
}

/// Whether the original has no far point with the coordinate of a sample that no face covers any more: the texture
/// would seem to have moved there.
bool TextureGuard::are_uncovered_free() {
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    const Match& m = matches_[i];
    if (m.is_inside) continue;
    const TextureMap::Sample& sample = map_.sample(samples_[i]);
    const CornerCoordinates& t = faces_[m.face].coordinates;
    const Eigen::Vector2d nearest = m.weights[0] * t[0] + m.weights[1] * t[1] + m.weights[2] * t[2];
    const std::uint32_t material = map_.material(faces_[m.face].number);
    if (map_.atlas().has_far_point(sample.coordinate, material, sample.at, map_.limit, found_)) return false;
    if (!is_strip_free(sample, nearest, material)) return false;
  }
  return true;
}

bool TextureGuard::is_near_original(const Face& face, const std::array<double, 3>& weights) {
  const CornerCoordinates& t = face.coordinates;
  const Eigen::Vector2d coordinate = weights[0] * t[0] + weights[1] * t[1] + weights[2] * t[2];
  const double squared =
      map_.atlas().squared_distance(coordinate, map_.material(face.number), point_of(face.at, weights), found_);
  return squared <= map_.limit * map_.limit || squared == HUGE_VAL;
}

/// Whether points of the faces are near the points of the original with the same coordinates, where such points exist.
bool TextureGuard::are_faces_near() {
  return std::all_of(faces_.begin(), faces_.end(), [&](const Face& face) {
    if (face.chart == no_index) return true;
    return std::all_of(tested_points.begin(), tested_points.end(),
                       [&](const std::array<double, 3>& weights) { return is_near_original(face, weights); });
  });
}

/// Compares the edges at the vertex that are lines after the collapse of an edge of a line, as `are_faces_near`
/// compares faces.
bool TextureGuard::are_lines_near() {
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    if (faces_[f].chart == no_index) continue;
    for (const std::size_t k : {std::size_t{0}, std::size_t{2}}) {
      if (!becomes_line(f, k)) continue;
      for (int i = 1; i < parts_of_line; ++i) {
        std::array<double, 3> weights{};
        weights[k] = static_cast<double>(i) / parts_of_line;
        weights[(k + 1) % 3] = 1 - weights[k];
        if (!is_near_original(faces_[f], weights)) return false;
      }
    }
  }
  return true;
}

/// Whether the first samples are near the faces, with the coordinate of the vertex where it is or at a better place.
bool TextureGuard::are_near(std::size_t count) {
  const double reach = (is_free_ ? hopeful_share : 1) * map_.limit;
  return match(count, reach * reach) && improve(count);
}

/// Whether the few samples leave any hope. Leaves the coordinate where it is.
bool TextureGuard::may_hold() {
  if (!is_free_) return are_near(few_samples);
  const Eigen::Vector2d coordinate = faces_[0].coordinates[0];
  const bool may_hold = are_near(few_samples);
  move_to(coordinate);
  return may_hold;
}

bool TextureGuard::holds(Vec3 point) {
  accepted_ = false;
  const bool is_bare = std::all_of(faces_.begin(), faces_.end(), [](const Face& f) { return f.chart == no_index; });
  if (is_bare) return true;
  if (!set_faces(point) || is_turned_over()) return false;
  if (has_many() && !may_hold()) return false;
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
    double least = HUGE_VAL;
    std::uint32_t best = no_index;
    for (const std::uint32_t f : faces) {
      if (mesh.is_removed(f) || map.chart(f) != chart) continue;
      const CornerCoordinates corners = map.of(f);
      double squared = 0;
      const auto weights = weights_at(corners, map.sample(s).coordinate);
      if (!weights || std::any_of(weights->begin(), weights->end(), [](double w) { return w < 0; }))
        (void)closest_on_outline(corners, map.sample(s).coordinate, squared);
      if (best == no_index || squared < least) least = squared, best = f;
    }
    map.lists.give_to(s, best);
  }
}

}  // namespace meshbound
