// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include "geometry/triangle_corners.h"
#include "proof/parity_patch.h"

namespace meshbound {

/// What the proofs that a triangle T lies near a soup look from: the prism over T', which is T a little shrunk, with
/// the heights that are allowed in it.
///
/// Rounding. It is the heights that carry the error of the projection, and tests against T' keep a rim that is wider
/// than theirs.
struct ParityView {
  /// Shrinking the triangle costs this share of the tolerance. It keeps walls that stand on an edge of it, as at the
  /// creases of machined parts, out of the prism.
  static constexpr double shrink_share = 1e-3;

  /// Nothing where the triangle is too thin, or the tolerance too small for doubles at this magnitude, the largest
  /// coordinate of the soup.
  [[nodiscard]] static std::optional<ParityView> of(const TriangleCorners& triangle, double tolerance,
                                                    double magnitude);

  FaceView view;
  Window<3> window;                   ///< T'
  double centre_x = 0, centre_y = 0;  ///< of it
  double height_limit = 0, rim = 0;
};

/// What is seen of one triangle of a soup, which tells `corners(t)` of triangle t.
template <class Soup>
struct Sight {
  const ParityView& from;
  const Soup& soup;
  ProjectedTriangle corners = {};
  /// How far each corner is beyond each side of T', by side and corner.
  std::array<std::array<double, 3>, 3> outside = {};
  mutable std::size_t edge_seen = 3;  ///< the edge whose passage was asked for last; 3: none since `look_at`

  void project(std::uint32_t t) {
    const TriangleCorners at = soup.corners(t);
    for (std::size_t k = 0; k < 3; ++k) corners[k] = from.view.project(at[k]);
  }
  bool look_at(std::uint32_t t) {
    project(t);
    edge_seen = 3;
    for (std::size_t side = 0; side < 3; ++side)
      for (std::size_t k = 0; k < 3; ++k) outside[side][k] = from.window.outside(side, corners[k]);
    const double limit = from.height_limit;
    if (std::abs(corners[0].h) <= limit && std::abs(corners[1].h) <= limit && std::abs(corners[2].h) <= limit)
      return true;
    for (const auto& of_side : outside)
      if (std::min({of_side[0], of_side[1], of_side[2]}) > from.rim) return true;
    return from.window.heights_within(corners, from.rim, from.height_limit);
  }
  [[nodiscard]] bool crosses_ray(std::size_t k) const {
    return meshbound::crosses_ray(corners[k], corners[(k + 1) % 3], from.centre_x, from.centre_y);
  }
  /// Whether the triangle that was projected last has a point over the middle of T'.
  [[nodiscard]] bool has_middle() const { return crosses_ray(0) ^ crosses_ray(1) ^ crosses_ray(2); }
  /// Whether all of the triangle that was projected last is too high, on the same side.
  [[nodiscard]] bool is_beyond_heights() const {
    const auto [low, high] = std::minmax({corners[0].h, corners[1].h, corners[2].h});
    return low > from.height_limit + from.rim || high < -from.height_limit - from.rim;
  }
  /// The triangle or the edge that was looked at last; an edge is a triangle without area.
  [[nodiscard]] ProjectedTriangle seen_last() const {
    if (edge_seen == 3) return corners;
    const Projected &p = corners[edge_seen], &q = corners[(edge_seen + 1) % 3];
    return {p, q, q};
  }
  /// Clear when a line separates the projected edge from T' by more than the rim.
  [[nodiscard]] Passage passage(std::size_t k) const {
    const std::size_t j = (k + 1) % 3;
    edge_seen = k;
    for (const auto& of_side : outside)
      if (of_side[k] > from.rim && of_side[j] > from.rim) return Passage::Clear;
    return from.window.is_beside_line(corners[k], corners[j], from.rim) ? Passage::Clear : Passage::Across;
  }
};

}  // namespace meshbound
