// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/vec3.h"

namespace meshbound {

/// Proves that a face lies within a tolerance of the original by the degree of a projection, without cutting the face.
///
/// Let P be a set of original triangles and T' the face, shrunk a little, seen from above. If no edge of the boundary
/// of P (an edge with an odd number of triangles of P) projects onto T', the number of triangles of P above a point of
/// T' is constant modulo 2 over T'. If it is odd at one point, every point of T' has a point of P straight above or
/// below it; and if P, clipped to the prism over T', has no height beyond the limit, that point is near. Nothing is
/// assumed of the original: it may fold or cross itself, several sheets may lie above each other.
///
/// Rounding. Corners are projected once each, by the same expression, so the projected triangles share their edges to
/// the bit and the argument above is exact for them; it is the heights that carry the error of the projection, and
/// tests against T' keep a rim that is wider than theirs (`covers`). The crossings counted for the parity take each
/// edge in the same direction from both its triangles, so interior edges cancel whatever rounding does.
class ParityProof {
 public:
  /// Shrinking the face costs this share of the tolerance. It keeps walls that stand on an edge of the face, as at the
  /// creases of machined parts, out of the prism.
  static constexpr double shrink_share = 1e-3;

  /// O(n log n). The arguments must outlive this.
  ParityProof(const std::vector<Vec3>& vertices, const std::vector<std::array<std::uint32_t, 3>>& triangles);

  /// True proves that `face` lies within `tolerance` of the original (but for CandidateFaces::rounding_slack of the
  /// largest coordinate); false says nothing. P grows from `seed` over the edges that project onto the face.
  [[nodiscard]] bool covers(const std::array<Vec3, 3>& face, double tolerance, double magnitude, std::uint32_t seed);

 private:
  static constexpr std::uint32_t no_neighbour = 0xffffffff;
  /// A corner as the face sees it: x and y in its plane, h above it.
  struct Projected {
    double x = 0, y = 0, h = 0;
  };
  using ProjectedTriangle = std::array<Projected, 3>;

  /// Of a triangle, at its corner and the next: the vertex of higher number.
  struct Side {
    std::uint32_t high, triangle, corner;
  };
  void find_neighbours();
  void match(std::span<Side> sides);
  [[nodiscard]] bool set_view(const std::array<Vec3, 3>& face, double tolerance, double magnitude);
  [[nodiscard]] Projected project(Vec3 p) const;
  [[nodiscard]] double outside(std::size_t side, const Projected& p) const {
    return side_x_[side] * p.x + side_y_[side] * p.y - side_offset_[side];
  }
  /// How far each corner is beyond each side of T'.
  using Beyond = std::array<std::array<double, 3>, 3>;  ///< by side and corner
  [[nodiscard]] Beyond beyond(const ProjectedTriangle& t) const;
  [[nodiscard]] bool heights_within(const ProjectedTriangle& t, const Beyond& beyond) const;
  [[nodiscard]] bool edge_is_clear(const ProjectedTriangle& t, std::size_t k, const Beyond& beyond) const;
  [[nodiscard]] bool above_centre(const ProjectedTriangle& t) const;

  const std::vector<Vec3>& vertices_;
  const std::vector<std::array<std::uint32_t, 3>>& triangles_;
  std::vector<std::array<std::uint32_t, 3>> neighbours_;  ///< across the edge from corner k to corner k + 1

  Vec3 origin_, x_axis_, y_axis_, z_axis_;
  std::array<double, 3> corner_x_{}, corner_y_{};              ///< of T'
  std::array<double, 3> side_x_{}, side_y_{}, side_offset_{};  ///< outward unit normals of its sides
  double centre_x_ = 0, centre_y_ = 0, height_limit_ = 0, rim_ = 0;

  std::vector<std::uint32_t> patch_, visited_;
  std::uint32_t round_ = 0;
};

}  // namespace meshbound
