// SPDX-License-Identifier: MIT
#include "certificate/parity_search.h"

#include <algorithm>
#include <cmath>

namespace meshbound {
namespace {

/// The share of the tolerance that drawing the piece in may cost, as the format has it.
constexpr double drawn_in_share = 0x1p-10;

/// Tests keep this share of the tolerance away from their limits; where rounding may come near it, we give up.
constexpr double rim_share = 0x1p-20;
/// Coordinates in a view, of points of magnitude 1, are off by less than 2^-47; a view by doubles of the exact plane,
/// in the sheared coordinates of the verifier's intervals, loses the squared ratio of length to width on top.
constexpr double view_error = 0x1p-46;

}  // namespace

ParitySearch::ParitySearch(const Bvh::Data& target, const std::vector<std::array<std::uint32_t, 3>>& neighbours,
                           const Goal& goal, double magnitude, std::size_t patch_limit)
    : b_(target),
      neighbours_(neighbours),
      tolerance_(goal.tolerance),
      slack_(goal.largest_slack()),
      magnitude_(magnitude),
      patch_(patch_limit) {}

/// False where the triangle is too thin, or the tolerance too small, for doubles to tell.
bool ParitySearch::set_view(const TriangleCorners& triangle, const Piece& piece) {
  const std::optional<FaceView> view = view_of(triangle);
  if (!view) return false;
  view_ = *view;
  const Vec3 ab = triangle[1] - triangle[0], ac = triangle[2] - triangle[0], bc = triangle[2] - triangle[1];
  const double longest = std::max({length(ab), length(ac), length(bc)});
  const double width = length(cross(ab, ac)) / longest, thinness = longest / width;
  rim_ = rim_share * tolerance_;
  tilt_ = view_error * magnitude_ / width;
  if (!(rim_ > 4 * slack_ && rim_ > view_error * magnitude_ * thinness * thinness && rim_ > 4 * tilt_ * tolerance_))
    return false;
  height_limit_ = tolerance_ * (1 - drawn_in_share) - slack_ - 4 * rim_;
  return height_limit_ > 0 && set_window(piece);
}

/// Sets the window: the piece as it is seen, drawn in as a reader does it.
bool ParitySearch::set_window(const Piece& piece) {
  window_.count = piece.count;
  const Vec3 middle = 0.5 * piece.corner(0) + 0.25 * (piece.corner(piece.count / 2) + piece.corner(piece.count - 1));
  double reach = 0;
  for (std::uint32_t i = 0; i < piece.count; ++i) reach = std::max(reach, length(middle - piece.corner(i)));
  const double wanted = 0.999 * drawn_in_share * tolerance_ / reach;
  // Next to a power of two a reader, which computes this in its own way, may take the other one.
  const double share = std::min(0.5, std::ldexp(1.0, std::ilogb(wanted)));
  if (!(wanted > 0x1p-40) || std::fabs(wanted / share - 1) < 1e-6 || std::fabs(wanted / share - 2) < 1e-6) return false;
  for (std::uint32_t i = 0; i < piece.count; ++i)
    window_.corner[i] = view_.project(piece.corner(i) + share * (middle - piece.corner(i)));
  return window_.set_sides(4 * rim_);
}

/// Whether a line separates the edge from the window by more than `margin`.
bool ParitySearch::is_clear(const Projected& p, const Projected& q, double margin) const {
  for (std::size_t side = 0; side < window_.count; ++side)
    if (window_.outside(side, p) > margin && window_.outside(side, q) > margin) return true;
  return window_.is_beside_line(p, q, margin);
}

/// What is seen of one triangle.
struct ParitySearch::Sight {
  const ParitySearch& search;
  ProjectedTriangle corners;

  bool look_at(std::uint32_t slot) {
    for (std::size_t k = 0; k < 3; ++k)
      corners[k] = search.view_.project(search.b_.vertices[search.b_.corners[slot][k]]);
    const double highest = std::max({std::abs(corners[0].h), std::abs(corners[1].h), std::abs(corners[2].h)});
    return highest <= search.height_limit_ ||
           search.window_.heights_within(corners, search.rim_ + search.tilt_ * highest, search.height_limit_);
  }
  /// From the first corner of the window: edges of the patch's boundary are clear of it.
  [[nodiscard]] bool crosses_ray(std::size_t k) const {
    const Projected& from = search.window_.corner[0];
    return meshbound::crosses_ray(corners[k], corners[(k + 1) % 3], from.x, from.y);
  }
  [[nodiscard]] Passage passage(std::size_t k) const {
    const Projected &p = corners[k], &q = corners[(k + 1) % 3];
    // How far the projected coordinates of the higher end may be off.
    const double margin = search.rim_ + search.tilt_ * std::max(std::abs(p.h), std::abs(q.h));
    if (search.is_clear(p, q, margin)) return Passage::Clear;
    return search.is_clear(p, q, -margin) ? Passage::Unclear : Passage::Across;
  }
};

bool ParitySearch::proves(const TriangleCorners& triangle, const Piece& piece, std::uint32_t seed) {
  patch_.clear();
  const auto neighbour = [&](std::uint32_t t, std::size_t k) { return neighbours_[t][k]; };
  if (!set_view(triangle, piece) || !patch_.covers(neighbour, seed, Sight{*this, {}})) return false;
  work_ += work_of_side * piece.count * patch_.size();
  return true;
}

}  // namespace meshbound
