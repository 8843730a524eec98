// SPDX-License-Identifier: MIT
#include "simplify/cover/parity_proof.h"

#include <algorithm>
#include <cmath>

namespace meshbound {
namespace {

/// Tests against the sides of T' are relaxed by this share of the tolerance. Coordinates in the view carry errors of
/// less than 2^-47 of the largest coordinate, sides 2^-45; `set_view` gives up where the rim is not wider.
constexpr double rim_share = 1e-6;
constexpr double min_rim = 0x1p-44;

/// A patch of more triangles is given up: a quarter of what a tile has.
constexpr std::size_t largest_patch = std::size_t{1} << 18;

}  // namespace

ParityProof::ParityProof(std::size_t triangle_count) : patch_(triangle_count, largest_patch) {}

/// Axes, T' and its sides. False where the triangle is too thin, or the tolerance too small for doubles at this size.
bool ParityProof::set_view(const std::array<Vec3, 3>& triangle, double tolerance, double magnitude) {
  rim_ = rim_share * tolerance;
  if (!(rim_ > min_rim * magnitude)) return false;
  const std::optional<FaceView> view = view_of(triangle);
  if (!view) return false;
  view_ = *view;
  ProjectedTriangle corners;
  for (std::size_t k = 0; k < 3; ++k) {
    corners[k] = view_.project(triangle[k]);
    if (std::abs(corners[k].h) > rim_) return false;  // the normal leans
  }
  const double middle_x = (corners[0].x + corners[1].x + corners[2].x) / 3;
  const double middle_y = (corners[0].y + corners[1].y + corners[2].y) / 3;
  const double diameter =
      std::sqrt(std::max({squared_length(triangle[1] - triangle[0]), squared_length(triangle[2] - triangle[0]),
                          squared_length(triangle[2] - triangle[1])}));
  const double keep = 1 - std::min(0.01, shrink_share * tolerance / diameter);
  window_.count = 3;
  for (std::size_t k = 0; k < 3; ++k)
    window_.corner[k] = {middle_x + keep * (corners[k].x - middle_x), middle_y + keep * (corners[k].y - middle_y), 0};
  if (!window_.set_sides(0)) return false;
  // Off the symmetric middle, where edges of regular meshes like to pass.
  const auto& [a, b, c] = window_.corner;
  centre_x_ = 0.35 * a.x + 0.34 * b.x + 0.31 * c.x;
  centre_y_ = 0.35 * a.y + 0.34 * b.y + 0.31 * c.y;
  height_limit_ = tolerance * (1 - shrink_share) - 4 * rim_;
  return true;
}

void ParityProof::note_obstacle(const Window<3>::Clipped& seen) {
  double min_share = HUGE_VAL;
  for (std::size_t side = 0; side < 3; ++side) {
    const double height = -window_.outside(side, window_.corner[(side + 2) % 3]);
    double depth = 0;
    for (const Projected& p : seen.corners()) depth = std::max(depth, -window_.outside(side, p));
    if (!(depth < min_share * height)) continue;
    min_share = depth / height;
    obstacle_ = {side, depth, height};
  }
}

}  // namespace meshbound
