// SPDX-License-Identifier: MIT
/// What `TextureGuard` looks up in the original: whether it has far points with the coordinates that the faces would
/// cover, or cover no more.
#include <algorithm>
#include <cmath>

#include "numeric/no_index.h"
#include "simplify/texture/texture_guard.h"
#include "simplify/texture/weighted_points.h"

namespace meshbound {
namespace {

/// The strip between a line of the original and the line that a collapse makes of it, in the texture, is sampled at
/// these shares of the way across.
constexpr std::array<double, 3> shares_of_strip = {0.02, 0.5, 0.98};

/// Edges are compared with the original at the ends of this many parts.
constexpr int parts_of_edge = 8;

/// Share of the limit: an edge whose middle is nearer than this is not looked at closely.
constexpr double doubtful_share = 0.5;

}  // namespace

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

void TextureGuard::find_lines() {
  of_lines_.clear();
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    if (faces_[f].chart == no_index) continue;
    for (std::size_t k = 0; k < 3; ++k)
      if (becomes_line(f, k)) of_lines_.push_back({f, k});
  }
}

/// Whether no point of the original whose coordinate lies in the strip between its line and that of the faces, in the
/// texture, is farther away than the limit: the result would show that texture at the line, or lack it there. Where the
/// chart has no area there is no strip: a face inside may have the coordinate as well.
bool TextureGuard::is_border_free(std::size_t i) {
  const Match& match = matches_[i];
  if (match.is_inside && !faces_[match.face].has_area) return true;
  const TextureMap::Sample& sample = map_.sample(samples_[i]);
  double least = HUGE_VAL;
  Eigen::Vector2d nearest = sample.coordinate;
  std::uint32_t material = 0;
  for (const auto& [f, k] : of_lines_) {
    if (faces_[f].chart != charts_[i]) continue;
    const Eigen::Vector2d &from = faces_[f].coordinates[k], &to = faces_[f].coordinates[(k + 1) % 3];
    const Eigen::Vector2d p = from + closest_share(from, to, sample.coordinate) * (to - from);
    const double squared = (p - sample.coordinate).squaredNorm();
    if (!(squared < least)) continue;
    least = squared;
    nearest = p;
    material = map_.material(faces_[f].number);
  }
  return least == 0 || least == HUGE_VAL || is_strip_free(sample, nearest, material);
}

bool TextureGuard::is_strip_free(const TextureMap::Sample& sample, const Eigen::Vector2d& nearest,
                                 std::uint32_t material) {
  return std::all_of(shares_of_strip.begin(), shares_of_strip.end(), [&](double share) {
    return has_no_far_point(sample.coordinate + share * (nearest - sample.coordinate), material, sample.at);
  });
}

bool TextureGuard::has_no_far_point(const Eigen::Vector2d& coordinate, std::uint32_t material, Vec3 p) {
  exceeding_squared_ = map_.atlas().squared_distance_of_far_point(coordinate, material, p, map_.limit, found_);
  return exceeding_squared_ == 0;
}

bool TextureGuard::are_borders_free() {
  if (!lines_.is_line(mesh_, star_.edge)) return true;
  find_lines();
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
    if (!has_no_far_point(sample.coordinate, material, sample.at)) return false;
    if (!is_strip_free(sample, nearest, material)) return false;
  }
  return true;
}

double TextureGuard::squared_deviation(const Face& face, const std::array<double, 3>& weights) {
  const CornerCoordinates& t = face.coordinates;
  const Eigen::Vector2d coordinate = weights[0] * t[0] + weights[1] * t[1] + weights[2] * t[2];
  return map_.atlas().squared_distance(coordinate, map_.material(face.number), point_of(face.at, weights), map_.limit,
                                       found_);
}

bool TextureGuard::is_edge_near(const EdgeOfFace& edge) {
  for (int i = 1; i < parts_of_edge; ++i) {
    std::array<double, 3> weights{};
    weights[edge.number] = static_cast<double>(i) / parts_of_edge;
    weights[(edge.number + 1) % 3] = 1 - weights[edge.number];
    if (squared_deviation(faces_[edge.face], weights) > map_.limit * map_.limit) return false;
  }
  return true;
}

/// Whether the vertex and the edges at it are near the points of the original with the same coordinates, where such
/// points exist. The third edge of a face is the first one of the next face, or a line.
bool TextureGuard::are_faces_near() {
  const double limit = map_.limit * map_.limit;
  const Face* before = nullptr;
  doubtful_.clear();
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    const Face& face = faces_[f];
    if (face.chart == no_index) continue;
    const bool is_vertex_known =
        before != nullptr && before->chart == face.chart && before->coordinates[0] == face.coordinates[0];
    before = &face;
    if (!is_vertex_known && squared_deviation(face, {1, 0, 0}) > limit) return false;
    const double in_the_middle = squared_deviation(face, {0.5, 0.5, 0});
    if (in_the_middle > limit) return false;
    if (in_the_middle > doubtful_share * doubtful_share * limit) doubtful_.push_back({f, 0});
  }
  return std::all_of(doubtful_.begin(), doubtful_.end(), [this](const EdgeOfFace& edge) { return is_edge_near(edge); });
}

/// Compares the edges at the vertex that are lines after the collapse of an edge of a line.
bool TextureGuard::are_lines_near() {
  return std::all_of(of_lines_.begin(), of_lines_.end(), [this](const EdgeOfFace& edge) {
    return edge.number == 1 || is_edge_near(edge);  // edge 1 is opposite to the vertex
  });
}

}  // namespace meshbound
