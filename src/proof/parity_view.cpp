// SPDX-License-Identifier: MIT
#include "proof/parity_view.h"

#include <algorithm>
#include <cmath>

namespace meshbound {
namespace {

/// Tests against the sides of T' are relaxed by this share of the tolerance. Coordinates in the view carry errors of
/// less than 2^-47 of the largest coordinate, sides 2^-45; there is no view where the rim is not wider.
constexpr double rim_share = 1e-6;
constexpr double min_rim = 0x1p-44;

}  // namespace

std::optional<ParityView> ParityView::of(const TriangleCorners& triangle, double tolerance, double magnitude) {
  const double rim = rim_share * tolerance;
  if (!(rim > min_rim * magnitude)) return std::nullopt;
  const std::optional<FaceView> view = view_of(triangle);
  if (!view) return std::nullopt;
  ProjectedTriangle corners;
  for (std::size_t k = 0; k < 3; ++k) {
    corners[k] = view->project(triangle[k]);
    if (std::abs(corners[k].h) > rim) return std::nullopt;  // the normal leans
  }
  const double middle_x = (corners[0].x + corners[1].x + corners[2].x) / 3;
  const double middle_y = (corners[0].y + corners[1].y + corners[2].y) / 3;
  const double diameter =
      std::sqrt(std::max({squared_length(triangle[1] - triangle[0]), squared_length(triangle[2] - triangle[0]),
                          squared_length(triangle[2] - triangle[1])}));
  const double keep = 1 - std::min(0.01, shrink_share * tolerance / diameter);
  Window<3> window;
  window.count = 3;
  for (std::size_t k = 0; k < 3; ++k)
    window.corner[k] = {middle_x + keep * (corners[k].x - middle_x), middle_y + keep * (corners[k].y - middle_y), 0};
  if (!window.set_sides(0)) return std::nullopt;
  // Off the symmetric middle, where edges of regular meshes like to pass.
  const auto& [a, b, c] = window.corner;
  return ParityView{*view,
                    window,
                    0.35 * a.x + 0.34 * b.x + 0.31 * c.x,
                    0.35 * a.y + 0.34 * b.y + 0.31 * c.y,
                    tolerance * (1 - shrink_share) - 4 * rim,
                    rim};
}

}  // namespace meshbound
