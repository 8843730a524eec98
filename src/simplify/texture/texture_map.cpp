// SPDX-License-Identifier: MIT
#include "simplify/texture/texture_map.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/boxes.h"
#include "numeric/no_index.h"
#include "simplify/texture/nearest_with_coordinate.h"
#include "simplify/texture/weighted_points.h"

namespace meshbound {
namespace {

/// Most samples between the ends of one edge: what these miss is seen where the new edges are looked at closely. With 5
/// a run takes 3% longer and leaves as many faces, with 2 more has to be taken back (seven models at three tolerances).
constexpr double max_between = 3;

/// Barycentric coordinates that are negative by no more than this count as 0, so that a point on an edge belongs to a
/// triangle.
constexpr double rounding = 1e-12;

/// Shares of the limit within which points are looked for, one after the other: most are much nearer than the limit.
constexpr std::array<double, 3> shares_of_reach = {1.0 / 16, 1.0 / 4, 1};

bool has_coordinates(const CornerCoordinates& corners) {
  return std::all_of(corners.begin(), corners.end(), [](const Eigen::Vector2d& uv) { return uv.allFinite(); });
}

/// Whether corners that have no area are not all equal.
bool is_line(const CornerCoordinates& corners) {
  return has_coordinates(corners) && (corners[0] != corners[1] || corners[0] != corners[2]);
}

Eigen::AlignedBox3d box_at(const Eigen::Vector2d& coordinate, std::uint32_t material) {
  const Eigen::Vector3d at(coordinate.x(), coordinate.y(), material);
  return {at, at};
}

/// A box around all coordinates that count as this one on a line.
Eigen::AlignedBox3d box_around(const Eigen::Vector2d& coordinate, std::uint32_t material) {
  const Eigen::Vector3d at(coordinate.x(), coordinate.y(), material),
      around = Eigen::Vector3d(1, 1, 0) * (rounding_of_coordinates * coordinate.norm());
  return {at - around, at + around};
}

Eigen::AlignedBox3d box_around(Vec3 p, double reach) {
  const Eigen::Vector3d at = to_eigen(p), around = Eigen::Vector3d::Constant(reach);
  return {at - around, at + around};
}

}  // namespace

Eigen::AlignedBox3d box_in_texture(const CornerCoordinates& corners, std::uint32_t material) {
  if (!(doubled_area(corners) != 0) || !has_coordinates(corners)) return {};
  return box_of(corners, material);
}

std::optional<std::array<double, 3>> weights_at(const CornerCoordinates& corners, const Eigen::Vector2d& coordinate) {
  const Eigen::Vector2d u = corners[1] - corners[0], v = corners[2] - corners[0], w = coordinate - corners[0];
  const double area = doubled_area(corners);
  if (area == 0) return std::nullopt;
  const double second = (w.x() * v.y() - w.y() * v.x()) / area, third = (u.x() * w.y() - u.y() * w.x()) / area;
  return std::array<double, 3>{1 - second - third, second, third};
}

std::optional<std::array<double, 3>> weights_inside(const CornerCoordinates& corners,
                                                    const Eigen::Vector2d& coordinate) {
  const auto weights = weights_at(corners, coordinate);
  if (!weights || std::any_of(weights->begin(), weights->end(), [](double w) { return w < -rounding; }))
    return std::nullopt;
  return weights;
}

Atlas::Atlas(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles,
             std::vector<CornerCoordinates> coordinates, std::vector<std::uint32_t> materials)
    : vertices_(vertices),
      triangles_(triangles),
      coordinates_(std::move(coordinates)),
      materials_(std::move(materials)) {
  std::vector<Eigen::AlignedBox3d> boxes(coordinates_.size()), on_lines, in_space(coordinates_.size());
  for (std::uint32_t t = 0; t < coordinates_.size(); ++t) {
    boxes[t] = box_in_texture(coordinates_[t], material(t));
    in_space[t] = box_of(corners(t));
    if (!boxes[t].isEmpty() || !is_line(coordinates_[t])) continue;
    on_lines.resize(boxes.size());
    on_lines[t] = box_of(coordinates_[t], material(t));
  }
  with_area_.emplace(boxes, in_space);
  if (with_area_->is_crowded()) hubs_ = Hubs(as_textured(), boxes);
  if (!hubs_.empty()) {
    for (std::size_t t = 0; t < boxes.size(); ++t)
      if (hubs_.has(t)) boxes[t].setEmpty();
    with_area_.emplace(boxes, in_space);
  }
  if (!on_lines.empty()) on_lines_.emplace(on_lines, in_space);
}

std::vector<TexturedTriangle> Atlas::as_textured() const {
  std::vector<TexturedTriangle> triangles(coordinates_.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    const TriangleCorners at = corners(t);
    triangles[t] = {{to_eigen(at[0]), to_eigen(at[1]), to_eigen(at[2])}, coordinates_[t], t, material(t)};
  }
  return triangles;
}

TriangleCorners Atlas::corners(std::uint32_t triangle) const {
  const Triangle& t = triangles_[triangle];
  return {vertices_[t[0]], vertices_[t[1]], vertices_[t[2]]};
}

std::optional<Vec3> Atlas::point(std::uint32_t triangle, const Eigen::Vector2d& coordinate) const {
  const auto weights = weights_at(coordinates_[triangle], coordinate);
  return weights ? std::optional(point_of(corners(triangle), *weights)) : std::nullopt;
}

/// The point of the triangle with this coordinate; absent if it has none.
std::optional<Vec3> Atlas::point_inside(std::uint32_t triangle, const Eigen::Vector2d& coordinate) const {
  const auto weights = weights_inside(coordinates_[triangle], coordinate);
  return weights ? std::optional(point_of(corners(triangle), *weights)) : std::nullopt;
}

/// Appends the triangles around hubs that may have a coordinate; of those that have the same point with it, one.
void Atlas::find_around_hubs(const Eigen::Vector2d& coordinate, std::uint32_t material,
                             std::vector<std::uint32_t>& found) const {
  if (hubs_.empty()) return;
  const Hubs::Coordinates at = {coordinate, coordinate, coordinate};
  hubs_.find(at, material, found);
  hubs_.find_touching(at, material, found);
}

/// The squared distance from `p` of the first point of the original with this coordinate and material whose squared
/// distance is accepted; 0 if there is none.
template <class Accept>
double Atlas::squared_distance_of_some_point(const Eigen::Vector2d& coordinate, std::uint32_t material, Vec3 p,
                                             std::vector<std::uint32_t>& found, const Accept& accept) const {
  BoxTree::Search in_areas(with_area_->in_texture(), box_at(coordinate, material));
  while (const std::optional<std::uint32_t> t = in_areas.next())
    if (const auto q = point_inside(*t, coordinate); q && accept(squared_length(*q - p))) return squared_length(*q - p);
  found.clear();
  find_around_hubs(coordinate, material, found);
  for (const std::uint32_t t : found)
    if (const auto q = point_inside(t, coordinate); q && accept(squared_length(*q - p))) return squared_length(*q - p);
  if (!on_lines_) return 0;
  BoxTree::Search in_lines(on_lines_->in_texture(), box_around(coordinate, material));
  while (const std::optional<std::uint32_t> t = in_lines.next()) {
    const auto q = nearest_with_coordinate(corners(*t), coordinates_[*t], coordinate, p);
    if (q && accept(squared_length(*q - p))) return squared_length(*q - p);
  }
  return 0;
}

double Atlas::squared_distance_of_far_point(const Eigen::Vector2d& coordinate, std::uint32_t material, Vec3 p,
                                            double limit, std::vector<std::uint32_t>& found) const {
  return squared_distance_of_some_point(coordinate, material, p, found,
                                        [limit](double squared) { return squared > limit * limit; });
}

double Atlas::squared_distance(const Eigen::Vector2d& coordinate, std::uint32_t material, Vec3 p, double limit,
                               std::vector<std::uint32_t>& found) const {
  double nearest = HUGE_VAL;
  found.clear();
  with_area_->find(box_at(coordinate, material), box_around(p, limit), found);
  find_around_hubs(coordinate, material, found);
  for (const std::uint32_t t : found)
    if (const auto q = point_inside(t, coordinate)) nearest = std::min(nearest, squared_length(*q - p));
  if (on_lines_ && !(nearest <= limit * limit))
    nearest = std::min(nearest, squared_distance_to_lines(coordinate, material, p, limit, found));
  if (nearest < HUGE_VAL) return nearest;
  return squared_distance_of_some_point(coordinate, material, p, found, [](double) { return true; });
}

/// As `squared_distance` among the triangles with a line of coordinates; infinite if none within the limit has the
/// coordinate. In a palette of gradients all of them may have it, so those near `p` in space come first.
double Atlas::squared_distance_to_lines(const Eigen::Vector2d& coordinate, std::uint32_t material, Vec3 p, double limit,
                                        std::vector<std::uint32_t>& found) const {
  double nearest = HUGE_VAL;
  for (const double share : shares_of_reach) {
    found.clear();
    on_lines_->find(box_around(coordinate, material), box_around(p, share * limit), found);
    for (const std::uint32_t t : found)
      if (const auto q = nearest_with_coordinate(corners(t), coordinates_[t], coordinate, p))
        nearest = std::min(nearest, squared_length(*q - p));
    if (nearest <= share * limit * (share * limit)) break;
  }
  return nearest;
}

TextureMap::TextureMap(Atlas atlas, const ArrayMesh& start, const FeatureLines& lines,
                       const std::vector<std::uint32_t>& triangle_of_face, const std::vector<Vec3>& vertices,
                       const std::vector<Triangle>& triangles, double spacing)
    : lists(start.face_count()), atlas_(std::move(atlas)), coordinates_(3 * start.face_count()) {
  material_.reserve(start.face_count());
  for (std::uint32_t f = 0; f < start.face_count(); ++f) {
    const std::uint32_t t = triangle_of_face[f];
    material_.push_back(atlas_.material(t));
    for (Corner c = 3 * f; c < 3 * f + 3; ++c) {
      const Vec3 p = start.position(start.start(c));  // faces may be turned over
      for (std::size_t k = 0; k < 3; ++k)
        if (squared_length(vertices[triangles[t][k]] - p) == 0) coordinates_[c] = atlas_.coordinates(t)[k];
    }
  }
  number_charts(start, lines);
  take_vertices(start, lines);
  take_edges(start, lines, spacing);
}

void TextureMap::number_charts(const ArrayMesh& start, const FeatureLines& lines) {
  chart_.assign(start.face_count(), no_index);
  std::vector<std::uint32_t> open;
  for (std::uint32_t first = 0; first < start.face_count(); ++first) {
    if (chart_[first] != no_index || !has_coordinates(of(first))) continue;
    chart_[first] = first;
    open.assign(1, first);
    while (!open.empty()) {
      const std::uint32_t f = open.back();
      open.pop_back();
      for (Corner c = 3 * f; c < 3 * f + 3; ++c) {
        if (lines.is_line(start, c)) continue;
        const std::uint32_t other = start.twin(c) / 3;
        if (chart_[other] != no_index || !has_coordinates(of(other))) continue;
        chart_[other] = first;
        open.push_back(other);
      }
    }
  }
}

void TextureMap::add_sample(std::uint32_t face, Vec3 at, const Eigen::Vector2d& coordinate, bool is_on_line) {
  samples_.push_back({at, coordinate, is_on_line});
  lists.add(face);
}

/// Takes one sample for each set of corners at a vertex that are connected without crossing a line.
void TextureMap::take_vertices(const ArrayMesh& start, const FeatureLines& lines) {
  std::vector<std::uint8_t> is_taken(3 * start.face_count(), 0);
  for (Corner first = 0; first < is_taken.size(); ++first) {
    if (is_taken[first] != 0 || chart_[first / 3] == no_index) continue;
    const std::uint32_t v = start.start(first);
    add_sample(first / 3, start.position(v), at(first), lines.is_on_line(v));
    for (Corner c = first; is_taken[c] == 0;) {
      is_taken[c] = 1;
      if (lines.is_line(start, c)) break;
      c = next_corner(start.twin(c));
    }
    for (Corner c = previous_corner(first); !lines.is_line(start, c); c = previous_corner(start.twin(c))) {
      if (is_taken[start.twin(c)] != 0) break;
      is_taken[start.twin(c)] = 1;
    }
  }
}

void TextureMap::take_edges(const ArrayMesh& start, const FeatureLines& lines, double spacing) {
  const auto count_on = [&](Corner c) -> double {
    if ((start.edge(c) != c && !lines.is_line(start, c)) || chart_[c / 3] == no_index) return 0;
    const double length = meshbound::length(start.position(start.end(c)) - start.position(start.start(c)));
    const double count = std::floor(length / spacing);
    return count >= 1 ? std::min(count, max_between) : 0;  // 0 also where it is not a number
  };
  std::vector<std::uint8_t> counts(3 * start.face_count());
  std::size_t all = samples_.size();
  for (Corner c = 0; c < counts.size(); ++c) all += counts[c] = static_cast<std::uint8_t>(count_on(c));
  samples_.reserve(all);
  lists.reserve(all);
  for (Corner c = 0; c < counts.size(); ++c) {
    if (counts[c] == 0) continue;
    const Vec3 p = start.position(start.start(c)), q = start.position(start.end(c));
    for (int k = 1; k <= counts[c]; ++k) {
      const double share = k / (counts[c] + 1.0);
      add_sample(c / 3, p + share * (q - p), at(c) + share * (at(next_corner(c)) - at(c)), lines.is_line(start, c));
    }
  }
}

}  // namespace meshbound
