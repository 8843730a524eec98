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

/// A patch of more triangles belongs to a face so large that cutting it is no slower.
constexpr std::size_t largest_patch = 20000;

}  // namespace

ParityProof::ParityProof(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles,
                         const std::vector<std::array<std::uint32_t, 3>>& neighbours)
    : vertices_(vertices), triangles_(triangles), neighbours_(neighbours), patch_(triangles.size(), largest_patch) {}

/// Axes, T' and its sides. False where the face is too thin, or the tolerance too small for doubles at this size.
bool ParityProof::set_view(const std::array<Vec3, 3>& face, double tolerance, double magnitude) {
  rim_ = rim_share * tolerance;
  if (!(rim_ > min_rim * magnitude)) return false;
  const std::optional<FaceView> view = view_of(face);
  if (!view) return false;
  view_ = *view;
  ProjectedTriangle corners;
  for (std::size_t k = 0; k < 3; ++k) {
    corners[k] = view_.project(face[k]);
    if (std::abs(corners[k].h) > rim_) return false;  // the normal leans
  }
  const double middle_x = (corners[0].x + corners[1].x + corners[2].x) / 3;
  const double middle_y = (corners[0].y + corners[1].y + corners[2].y) / 3;
  const double diameter = std::sqrt(std::max(
      {squared_length(face[1] - face[0]), squared_length(face[2] - face[0]), squared_length(face[2] - face[1])}));
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

/// What is seen of one triangle.
struct ParityProof::Sight {
  const ParityProof& proof;
  ProjectedTriangle corners;
  std::array<std::array<double, 3>, 3> outside;  ///< how far each corner is beyond each side of T', by side and corner

  bool look_at(std::uint32_t t) {
    for (std::size_t k = 0; k < 3; ++k) corners[k] = proof.view_.project(proof.vertices_[proof.triangles_[t][k]]);
    for (std::size_t side = 0; side < 3; ++side)
      for (std::size_t k = 0; k < 3; ++k) outside[side][k] = proof.window_.outside(side, corners[k]);
    if (std::max({std::abs(corners[0].h), std::abs(corners[1].h), std::abs(corners[2].h)}) <= proof.height_limit_)
      return true;
    for (const auto& of_side : outside)
      if (std::min({of_side[0], of_side[1], of_side[2]}) > proof.rim_) return true;
    return proof.window_.heights_within(corners, proof.rim_, proof.height_limit_);
  }
  [[nodiscard]] bool crosses_ray(std::size_t k) const {
    return meshbound::crosses_ray(corners[k], corners[(k + 1) % 3], proof.centre_x_, proof.centre_y_);
  }
  /// Clear when a line separates the projected edge from T' by more than the rim.
  [[nodiscard]] Passage passage(std::size_t k) const {
    const std::size_t j = (k + 1) % 3;
    for (const auto& of_side : outside)
      if (of_side[k] > proof.rim_ && of_side[j] > proof.rim_) return Passage::Clear;
    return proof.window_.is_beside_line(corners[k], corners[j], proof.rim_) ? Passage::Clear : Passage::Across;
  }
};

bool ParityProof::covers(const std::array<Vec3, 3>& face, double tolerance, double magnitude, std::uint32_t seed) {
  return set_view(face, tolerance, magnitude) && patch_.covers(neighbours_, seed, Sight{*this, {}, {}});
}

}  // namespace meshbound
