// SPDX-License-Identifier: MIT
#include "simplify/parity_proof.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <tuple>

namespace meshbound {
namespace {

/// Tests against the sides of T' are relaxed by this share of the tolerance. Coordinates in the view carry errors of
/// less than 2^-47 of the largest coordinate, sides 2^-45; `set_view` gives up where the rim is not wider.
constexpr double rim_share = 1e-6;
constexpr double min_rim = 0x1p-44;

/// A patch of more triangles belongs to a face so large that cutting it is no slower.
constexpr std::size_t largest_patch = 20000;

/// A triangle clipped by three lines has at most six corners.
constexpr std::size_t max_clipped = 8;

std::vector<std::uint32_t> first_of_equal(const std::vector<Vec3>& vertices) {
  std::vector<std::uint32_t> order(vertices.size()), first(vertices.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto key = [&](std::uint32_t v) { return std::tuple(vertices[v].x, vertices[v].y, vertices[v].z); };
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool repeats = i > 0 && key(order[i]) == key(order[i - 1]);
    first[order[i]] = repeats ? first[order[i - 1]] : order[i];
  }
  return first;
}

}  // namespace

ParityProof::ParityProof(const std::vector<Vec3>& vertices, const std::vector<std::array<std::uint32_t, 3>>& triangles)
    : vertices_(vertices), triangles_(triangles), visited_(triangles.size(), 0) {
  find_neighbours();
}

/// Neighbours across edges of exactly two triangles, vertices of equal coordinates being one. Any other edge counts as
/// boundary, which can only make a proof fail. Sides are sorted by their lower vertex, and compared with the others
/// there.
void ParityProof::find_neighbours() {
  const std::vector<std::uint32_t> first = first_of_equal(vertices_);
  neighbours_.assign(triangles_.size(), {no_neighbour, no_neighbour, no_neighbour});
  const auto for_each_side = [&](const auto& use) {
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
      const auto& c = triangles_[t];
      const std::array<std::uint32_t, 3> v = {first[c[0]], first[c[1]], first[c[2]]};
      if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) continue;
      for (std::uint32_t k = 0; k < 3; ++k)
        use(std::min(v[k], v[(k + 1) % 3]), Side{std::max(v[k], v[(k + 1) % 3]), t, k});
    }
  };
  std::vector<std::size_t> end(vertices_.size() + 1, 0);  // of the sides of each vertex, once these are put in
  for_each_side([&](std::uint32_t low, const Side&) { ++end[low + 1]; });
  std::partial_sum(end.begin(), end.end(), end.begin());
  std::vector<Side> sides(end.back());
  for_each_side([&](std::uint32_t low, const Side& side) { sides[end[low]++] = side; });
  std::size_t begin = 0;
  for (const std::size_t stop : std::span(end).first(vertices_.size())) {
    match(std::span(sides).subspan(begin, stop - begin));
    begin = stop;
  }
}

/// Sides that have one vertex in common.
void ParityProof::match(std::span<Side> sides) {
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) { return a.high < b.high; });
  for (std::size_t i = 0, j; i < sides.size(); i = j) {
    for (j = i + 1; j < sides.size() && sides[j].high == sides[i].high;) ++j;
    if (j - i != 2) continue;
    neighbours_[sides[i].triangle][sides[i].corner] = sides[i + 1].triangle;
    neighbours_[sides[i + 1].triangle][sides[i + 1].corner] = sides[i].triangle;
  }
}

ParityProof::Projected ParityProof::project(Vec3 p) const {
  const Vec3 q = p - origin_;
  return {dot(q, x_axis_), dot(q, y_axis_), dot(q, z_axis_)};
}

/// Axes, T' and its sides. False where the face is too thin, or the tolerance too small for doubles at this size.
bool ParityProof::set_view(const std::array<Vec3, 3>& face, double tolerance, double magnitude) {
  rim_ = rim_share * tolerance;
  if (!(rim_ > min_rim * magnitude)) return false;
  origin_ = face[0];
  const Vec3 ab = face[1] - face[0], ac = face[2] - face[0];
  const Vec3 normal = cross(ab, ac);
  const double area = length(normal);
  if (!(area > 0)) return false;
  z_axis_ = (1 / area) * normal;
  // The normal of a thin face may lean; the axes are orthonormal nevertheless, and the corners of the face must turn
  // out to have no height.
  const Vec3 along = ab - dot(ab, z_axis_) * z_axis_;
  const double along_length = length(along);
  if (!(along_length > 0)) return false;
  x_axis_ = (1 / along_length) * along;
  y_axis_ = cross(z_axis_, x_axis_);
  ProjectedTriangle corners;
  for (std::size_t k = 0; k < 3; ++k) {
    corners[k] = project(face[k]);
    if (std::abs(corners[k].h) > rim_) return false;
  }
  const double middle_x = (corners[0].x + corners[1].x + corners[2].x) / 3;
  const double middle_y = (corners[0].y + corners[1].y + corners[2].y) / 3;
  const double diameter =
      std::sqrt(std::max({squared_length(ab), squared_length(ac), squared_length(face[2] - face[1])}));
  const double keep = 1 - std::min(0.01, shrink_share * tolerance / diameter);
  for (std::size_t k = 0; k < 3; ++k) {
    corner_x_[k] = middle_x + keep * (corners[k].x - middle_x);
    corner_y_[k] = middle_y + keep * (corners[k].y - middle_y);
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t j = (k + 1) % 3;
    const double dx = corner_x_[j] - corner_x_[k], dy = corner_y_[j] - corner_y_[k];
    const double side = std::sqrt(dx * dx + dy * dy);
    if (!(side > 0)) return false;
    side_x_[k] = dy / side;
    side_y_[k] = -dx / side;
    side_offset_[k] = side_x_[k] * corner_x_[k] + side_y_[k] * corner_y_[k];
  }
  // Off the symmetric middle, where edges of regular meshes like to pass.
  centre_x_ = 0.35 * corner_x_[0] + 0.34 * corner_x_[1] + 0.31 * corner_x_[2];
  centre_y_ = 0.35 * corner_y_[0] + 0.34 * corner_y_[1] + 0.31 * corner_y_[2];
  height_limit_ = tolerance * (1 - shrink_share) - 4 * rim_;
  return true;
}

ParityProof::Beyond ParityProof::beyond(const ProjectedTriangle& t) const {
  Beyond beyond;
  for (std::size_t side = 0; side < 3; ++side) {
    for (std::size_t k = 0; k < 3; ++k) beyond[side][k] = outside(side, t[k]);
  }
  return beyond;
}

/// Clips the triangle to the prism over T' and its rim, and looks at the heights of what is left.
bool ParityProof::heights_within(const ProjectedTriangle& t, const Beyond& beyond) const {
  if (std::max({std::abs(t[0].h), std::abs(t[1].h), std::abs(t[2].h)}) <= height_limit_) return true;
  for (const auto& of_side : beyond) {
    if (std::min({of_side[0], of_side[1], of_side[2]}) > rim_) return true;
  }
  std::array<Projected, max_clipped> polygon{t[0], t[1], t[2]}, clipped;
  std::size_t count = 3;
  for (std::size_t side = 0; side < 3; ++side) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const Projected &p = polygon[i], &q = polygon[(i + 1) % count];
      const double at_p = outside(side, p) - rim_, at_q = outside(side, q) - rim_;
      if (at_p <= 0) clipped[kept++] = p;
      if ((at_p <= 0) != (at_q <= 0)) {
        const double s = at_p / (at_p - at_q);
        clipped[kept++] = {p.x + s * (q.x - p.x), p.y + s * (q.y - p.y), p.h + s * (q.h - p.h)};
      }
    }
    polygon = clipped;
    count = kept;
  }
  return std::all_of(polygon.begin(), polygon.begin() + static_cast<std::ptrdiff_t>(count),
                     [&](const Projected& p) { return std::abs(p.h) <= height_limit_; });
}

/// True when a line separates the projected edge from T' by more than the rim.
bool ParityProof::edge_is_clear(const ProjectedTriangle& t, std::size_t k, const Beyond& beyond) const {
  const std::size_t j = (k + 1) % 3;
  for (const auto& of_side : beyond) {
    if (of_side[k] > rim_ && of_side[j] > rim_) return true;
  }
  const Projected &p = t[k], &q = t[j];
  const double dx = q.x - p.x, dy = q.y - p.y;
  double least = HUGE_VAL, most = -HUGE_VAL;
  for (std::size_t i = 0; i < 3; ++i) {
    const double turn = dx * (corner_y_[i] - p.y) - dy * (corner_x_[i] - p.x);
    least = std::min(least, turn);
    most = std::max(most, turn);
  }
  const double clearance = rim_ * (std::abs(dx) + std::abs(dy));
  return least > clearance || most < -clearance;
}

/// Whether a ray from the centre of T' crosses the outline of the projected triangle an odd number of times.
bool ParityProof::above_centre(const ProjectedTriangle& t) const {
  bool odd = false;
  for (std::size_t k = 0; k < 3; ++k) {
    const Projected* low = &t[k];
    const Projected* high = &t[(k + 1) % 3];
    if ((low->y > centre_y_) == (high->y > centre_y_)) continue;
    if (low->y > high->y) std::swap(low, high);
    const double x = low->x + (high->x - low->x) * ((centre_y_ - low->y) / (high->y - low->y));
    if (centre_x_ < x) odd = !odd;
  }
  return odd;
}

bool ParityProof::covers(const std::array<Vec3, 3>& face, double tolerance, double magnitude, std::uint32_t seed) {
  if (!set_view(face, tolerance, magnitude)) return false;
  ++round_;
  patch_.assign(1, seed);
  visited_[seed] = round_;
  bool odd = false;
  for (std::size_t i = 0; i < patch_.size(); ++i) {
    const std::uint32_t t = patch_[i];
    ProjectedTriangle corners;
    for (std::size_t k = 0; k < 3; ++k) corners[k] = project(vertices_[triangles_[t][k]]);
    const Beyond sides = beyond(corners);
    if (!heights_within(corners, sides)) return false;
    if (above_centre(corners)) odd = !odd;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t next = neighbours_[t][k];
      if (next != no_neighbour && visited_[next] == round_) continue;
      if (edge_is_clear(corners, k, sides)) continue;
      if (next == no_neighbour || patch_.size() == largest_patch) return false;
      visited_[next] = round_;
      patch_.push_back(next);
    }
  }
  return odd;
}

}  // namespace meshbound
