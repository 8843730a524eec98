// SPDX-License-Identifier: MIT
/// The parity proof: that a convex window in the plane of a face lies within a height of a triangle soup, without
/// cutting the face.
///
/// Let P be a set of triangles of the soup, all seen along the normal of the face. If no edge of the boundary of P (an
/// edge with an odd number of triangles of P) projects onto the window, the number of triangles of P above a point of
/// the window is constant modulo 2 over the window. If it is odd at one point, every point of the window has a point of
/// P straight above or below it; and if P, clipped to the prism over the window, has no height beyond the limit, that
/// point is near. Nothing is assumed of the soup: it may fold or cross itself, several sheets may lie above each other.
///
/// Each vertex is projected by one and the same expression, so the projected triangles share their edges to the bit and
/// the argument above is exact for them. The crossings that are counted for the parity take each edge in the same
/// direction from both its triangles, so interior edges cancel whatever rounding does. What rounding does to heights
/// and to tests against the window is left to those who use this: they keep a rim around the window.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "geometry/triangle_corners.h"
#include "geometry/unit.h"
#include "geometry/vec3.h"
#include "numeric/marked_ids.h"
#include "numeric/no_index.h"

namespace meshbound {

/// A point as a face sees it: x and y in its plane, h above it.
struct Projected {
  double x = 0, y = 0, h = 0;
};
using ProjectedTriangle = std::array<Projected, 3>;

/// Orthonormal axes of a face, z along its normal, origin at its first corner.
struct FaceView {
  Vec3 origin, x_axis, y_axis, z_axis;

  [[nodiscard]] Projected project(const Vec3& p) const {
    const Vec3 q = p - origin;
    return {dot(q, x_axis), dot(q, y_axis), dot(q, z_axis)};
  }
};

/// Nothing for a face without an accurate area: the axes would not have the length 1.
[[nodiscard]] inline std::optional<FaceView> view_of(const TriangleCorners& face) {
  const Vec3 ab = face[1] - face[0], normal = cross(ab, face[2] - face[0]);
  const double area = length(normal);
  if (!(area > least_accurate_length)) return std::nullopt;
  FaceView view;
  view.origin = face[0];
  view.z_axis = (1 / area) * normal;
  // The normal of a thin face may lean; the axes are orthonormal nevertheless.
  const Vec3 along = ab - dot(ab, view.z_axis) * view.z_axis;
  const double along_length = length(along);
  if (!(along_length > least_accurate_length)) return std::nullopt;
  view.x_axis = (1 / along_length) * along;
  view.y_axis = cross(view.z_axis, view.x_axis);
  return view;
}

/// A convex polygon in a view, of at most `capacity` corners, with the outward unit normals of its sides.
template <std::size_t capacity>
struct Window {
  std::size_t count = 0;
  std::array<Projected, capacity> corner;  ///< their heights do not matter
  std::array<double, capacity> side_x{}, side_y{}, side_offset{};

  /// Sets the sides from the corners. False where one is not longer than `min_length`.
  [[nodiscard]] bool set_sides(double min_length) {
    for (std::size_t k = 0; k < count; ++k) {
      const Projected &from = corner[k], &to = corner[(k + 1) % count];
      const double dx = to.x - from.x, dy = to.y - from.y, side = std::sqrt(dx * dx + dy * dy);
      if (!(side > min_length)) return false;
      side_x[k] = dy / side;
      side_y[k] = -dx / side;
      side_offset[k] = side_x[k] * from.x + side_y[k] * from.y;
    }
    return true;
  }

  /// How far a point is beyond the line of a side.
  [[nodiscard]] double outside(std::size_t side, const Projected& p) const {
    return side_x[side] * p.x + side_y[side] * p.y - side_offset[side];
  }

  /// Whether the line through an edge has the whole window on one side, by more than `margin`.
  [[nodiscard]] bool is_beside_line(const Projected& p, const Projected& q, double margin) const {
    const double dx = q.x - p.x, dy = q.y - p.y;
    double min = HUGE_VAL, max = -HUGE_VAL;
    for (std::size_t k = 0; k < count; ++k) {
      const double turn = dx * (corner[k].y - p.y) - dy * (corner[k].x - p.x);
      min = std::min(min, turn);
      max = std::max(max, turn);
    }
    const double clearance = margin * (std::abs(dx) + std::abs(dy));
    return min > clearance || max < -clearance;
  }

  /// A polygon clipped to the prism over the window; each side adds a corner at most.
  struct Clipped {
    std::array<Projected, capacity + 4> corner;
    std::size_t count = 0;
    [[nodiscard]] std::span<const Projected> corners() const { return {corner.data(), count}; }
  };
  /// Clips a triangle to the prism over the window and `margin` around it.
  [[nodiscard]] Clipped clipped(const ProjectedTriangle& t, double margin) const {
    Clipped polygon{{t[0], t[1], t[2]}, 3};
    std::array<double, capacity + 4> beyond;
    for (std::size_t side = 0; side < count; ++side) {
      bool is_cut = false;
      for (std::size_t i = 0; i < polygon.count; ++i) {
        beyond[i] = outside(side, polygon.corner[i]) - margin;
        is_cut = is_cut || !(beyond[i] <= 0);
      }
      if (!is_cut) continue;
      const Clipped whole = polygon;
      polygon.count = 0;
      for (std::size_t i = 0; i < whole.count; ++i) {
        const std::size_t j = i + 1 == whole.count ? 0 : i + 1;
        const Projected &p = whole.corner[i], &q = whole.corner[j];
        if (beyond[i] <= 0) polygon.corner[polygon.count++] = p;
        if ((beyond[i] <= 0) == (beyond[j] <= 0)) continue;
        const double s = beyond[i] / (beyond[i] - beyond[j]);
        polygon.corner[polygon.count++] = {p.x + s * (q.x - p.x), p.y + s * (q.y - p.y), p.h + s * (q.h - p.h)};
      }
    }
    return polygon;
  }
  /// Whether a triangle, clipped to the prism over the window and `margin` around it, has no height beyond `limit`.
  [[nodiscard]] bool heights_within(const ProjectedTriangle& t, double margin, double limit) const {
    const Clipped polygon = clipped(t, margin);
    const std::span<const Projected> corners = polygon.corners();
    return std::all_of(corners.begin(), corners.end(), [&](const Projected& p) { return std::abs(p.h) <= limit; });
  }
};

/// Whether a projected edge crosses the ray from a point of the window in the direction of x. The answer is the same
/// for both directions of the edge.
[[nodiscard]] inline bool crosses_ray(const Projected& p, const Projected& q, double from_x, double from_y) {
  if ((p.y > from_y) == (q.y > from_y)) return false;
  const Projected &low = p.y < q.y ? p : q, &high = p.y < q.y ? q : p;
  return (high.x - low.x) * (from_y - low.y) - (high.y - low.y) * (from_x - low.x) > 0;
}

/// How the projection of an edge lies to the window: apart from it, across it, or too near to its rim to tell.
enum class Passage { Clear, Across, Unclear };

/// Grows the set P over a window. Not thread-safe.
class ParityPatch {
 public:
  /// P gets at most `max_triangles`.
  explicit ParityPatch(std::size_t max_triangles) : max_triangles_(max_triangles) {}

  /// Grows P from `seed` over the edges that project onto the window. True when no edge of its boundary does, no
  /// triangle is too high and the parity is odd. `neighbour(t, k)` is the triangle across the edge of t from corner k,
  /// or `no_index`. `sight` tells what is seen: look_at(triangle) projects a triangle and says whether its heights
  /// hold, passage(k) and crosses_ray(k) are of the edge from corner k of that triangle; the ray begins at one point of
  /// the window. O(size of P).
  template <class Neighbour, class Sight>
  [[nodiscard]] bool covers(const Neighbour& neighbour, std::uint32_t seed, Sight&& sight) {
    visited_.clear();
    triangles_.assign(1, seed);
    visited_.insert(seed);
    bool odd = false;
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
      const std::uint32_t t = triangles_[i];
      if (!sight.look_at(t)) return false;
      for (std::size_t k = 0; k < 3; ++k) {
        if (sight.crosses_ray(k)) odd = !odd;
        const std::uint32_t next = neighbour(t, k);
        if (next != no_index && visited_.contains(next)) continue;
        const Passage passage = sight.passage(k);
        if (passage == Passage::Clear) continue;
        if (passage == Passage::Unclear || next == no_index || triangles_.size() == max_triangles_) return false;
        visited_.insert(next);
        triangles_.push_back(next);
      }
    }
    return odd;
  }

  /// P after the last `covers`.
  [[nodiscard]] std::span<const std::uint32_t> triangles() const { return triangles_; }
  /// Number of triangles after the last `covers`.
  [[nodiscard]] std::size_t size() const { return triangles_.size(); }
  /// Whether the last `covers` may have failed because P grew too large: parts of the window may do.
  [[nodiscard]] bool is_full() const { return triangles_.size() == max_triangles_; }
  void clear() { triangles_.clear(); }

 private:
  std::vector<std::uint32_t> triangles_;
  MarkedIds visited_;
  std::size_t max_triangles_;
};

}  // namespace meshbound
