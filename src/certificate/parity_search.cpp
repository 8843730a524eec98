// SPDX-License-Identifier: MIT
#include "certificate/parity_search.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace meshbound {
namespace {

/// The format: what drawing the piece in may cost.
constexpr double drawn_in_share = 0x1p-10;

/// Tests keep this share of the tolerance away from their limits; where rounding may come near it, we give up.
constexpr double rim_share = 0x1p-20;
/// Coordinates in a view, of points of magnitude 1, are off by less than 2^-47; a view by doubles of the exact plane,
/// in the sheared coordinates of the verifier's intervals, loses the squared ratio of length to width on top.
constexpr double view_error = 0x1p-46;

/// A triangle clipped by the sides of a piece.
constexpr std::size_t max_clipped = Piece::capacity + 4;

}  // namespace

/// Vertices of equal coordinates are one vertex, triangles with two equal corners are left out, as for the reader.
/// Places that the working frame makes equal may differ in the model; there the edges are taken for boundary.
PatchNeighbours::PatchNeighbours(const Bvh::Data& target) {
  struct Side {
    std::uint32_t low, high, slot, corner;
  };
  std::vector<std::uint32_t> order(target.vertices.size()), first(target.vertices.size());
  std::iota(order.begin(), order.end(), 0U);
  const auto key = [&](std::uint32_t v) {
    return std::tuple(target.vertices[v].x, target.vertices[v].y, target.vertices[v].z);
  };
  std::sort(order.begin(), order.end(), [&](std::uint32_t v, std::uint32_t w) { return key(v) < key(w); });
  for (std::size_t i = 0; i < order.size(); ++i)
    first[order[i]] = i > 0 && key(order[i]) == key(order[i - 1]) ? first[order[i - 1]] : order[i];

  across.assign(target.triangle_count(), {boundary, boundary, boundary});
  usable.assign(target.triangle_count(), false);
  std::vector<Side> sides;
  sides.reserve(3 * std::size_t{target.triangle_count()});
  for (std::uint32_t slot = 0; slot < target.triangle_count(); ++slot) {
    const Triangle& c = target.corners[slot];
    if (first[c[0]] == first[c[1]] || first[c[1]] == first[c[2]] || first[c[2]] == first[c[0]]) continue;
    usable[slot] = true;
    for (std::uint32_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(first[c[k]], first[c[(k + 1) % 3]]);
      sides.push_back({low, high, slot, k});
    }
  }
  std::sort(sides.begin(), sides.end(),
            [](const Side& s, const Side& t) { return std::tie(s.low, s.high) < std::tie(t.low, t.high); });
  for (std::size_t i = 0, j = 0; i < sides.size(); i = j) {
    while (j < sides.size() && sides[j].low == sides[i].low && sides[j].high == sides[i].high) ++j;
    if (j - i != 2) continue;
    across[sides[i].slot][sides[i].corner] = sides[i + 1].slot;
    across[sides[i + 1].slot][sides[i + 1].corner] = sides[i].slot;
  }
}

ParitySearch::ParitySearch(const Bvh::Data& target, const PatchNeighbours& neighbours, const Goal& goal,
                           double magnitude, std::size_t patch_limit)
    : b_(target),
      neighbours_(neighbours),
      tolerance_(goal.tolerance),
      slack_(goal.largest_slack()),
      magnitude_(magnitude),
      visited_(target.triangle_count(), 0),
      patch_limit_(patch_limit) {}

ParitySearch::Seen ParitySearch::see(const Vec3& p) const {
  const Vec3 q = p - origin_;
  return {dot(q, x_axis_), dot(q, y_axis_), dot(q, z_axis_)};
}

/// False where the triangle is too thin, or the tolerance too small, for doubles to tell.
bool ParitySearch::set_view(const std::array<Vec3, 3>& triangle, const Piece& piece) {
  origin_ = triangle[0];
  const Vec3 ab = triangle[1] - triangle[0], ac = triangle[2] - triangle[0], bc = triangle[2] - triangle[1];
  const Vec3 normal = cross(ab, ac);
  const double area = length(normal), longest = std::max({length(ab), length(ac), length(bc)});
  if (!(area > 0)) return false;
  const double width = area / longest, thinness = longest / width;
  rim_ = rim_share * tolerance_;
  tilt_ = view_error * magnitude_ / width;
  if (!(rim_ > 4 * slack_ && rim_ > view_error * magnitude_ * thinness * thinness && rim_ > 4 * tilt_ * tolerance_))
    return false;
  z_axis_ = (1 / area) * normal;
  const Vec3 along = ab - dot(ab, z_axis_) * z_axis_;
  x_axis_ = (1 / length(along)) * along;
  y_axis_ = cross(z_axis_, x_axis_);
  height_limit_ = tolerance_ * (1 - drawn_in_share) - slack_ - 4 * rim_;
  return height_limit_ > 0 && set_window(piece);
}

/// The piece as it is seen, drawn in as a reader does it, and its sides.
bool ParitySearch::set_window(const Piece& piece) {
  sides_ = piece.count;
  const Vec3 middle = 0.5 * piece.corner(0) + 0.25 * (piece.corner(piece.count / 2) + piece.corner(piece.count - 1));
  double reach = 0;
  for (std::uint32_t i = 0; i < piece.count; ++i) reach = std::max(reach, length(middle - piece.corner(i)));
  const double wanted = 0.999 * drawn_in_share * tolerance_ / reach;
  // Next to a power of two the reader may take the other one.
  const double share = std::min(0.5, std::ldexp(1.0, std::ilogb(wanted)));
  if (!(wanted > 0x1p-40) || std::fabs(wanted / share - 1) < 1e-6 || std::fabs(wanted / share - 2) < 1e-6) return false;
  for (std::uint32_t i = 0; i < piece.count; ++i)
    window_[i] = see(piece.corner(i) + share * (middle - piece.corner(i)));
  for (std::size_t k = 0; k < sides_; ++k) {
    const Seen &from = window_[k], &to = window_[(k + 1) % sides_];
    const double dx = to.x - from.x, dy = to.y - from.y, side = std::hypot(dx, dy);
    if (!(side > 4 * rim_)) return false;
    side_x_[k] = dy / side;
    side_y_[k] = -dx / side;
    side_offset_[k] = side_x_[k] * from.x + side_y_[k] * from.y;
  }
  return true;
}

/// Clips the triangle to the prism over the window, a rim wider.
bool ParitySearch::heights_hold(const SeenTriangle& t) const {
  const double highest = std::max({std::abs(t[0].h), std::abs(t[1].h), std::abs(t[2].h)});
  if (highest <= height_limit_) return true;
  const double margin = rim_ + tilt_ * highest;
  std::array<Seen, max_clipped> polygon{t[0], t[1], t[2]}, kept;
  std::size_t count = 3;
  for (std::size_t side = 0; side < sides_; ++side) {
    std::size_t kept_count = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const Seen &p = polygon[i], &q = polygon[(i + 1) % count];
      const double at_p = outside(side, p) - margin, at_q = outside(side, q) - margin;
      if (at_p <= 0) kept[kept_count++] = p;
      if ((at_p <= 0) == (at_q <= 0)) continue;
      const double s = at_p / (at_p - at_q);
      kept[kept_count++] = {p.x + s * (q.x - p.x), p.y + s * (q.y - p.y), p.h + s * (q.h - p.h)};
    }
    std::copy_n(kept.begin(), kept_count, polygon.begin());
    count = kept_count;
  }
  return std::all_of(polygon.begin(), polygon.begin() + static_cast<std::ptrdiff_t>(count),
                     [&](const Seen& p) { return std::abs(p.h) <= height_limit_; });
}

/// Whether a line separates the edge from the window by more than `margin`.
bool ParitySearch::is_clear(const Seen& p, const Seen& q, double margin) const {
  for (std::size_t side = 0; side < sides_; ++side)
    if (outside(side, p) > margin && outside(side, q) > margin) return true;
  const double dx = q.x - p.x, dy = q.y - p.y, room = margin * std::hypot(dx, dy);
  bool all_left = true, all_right = true;
  for (std::size_t k = 0; k < sides_; ++k) {
    const double turn = dx * (window_[k].y - p.y) - dy * (window_[k].x - p.x);
    all_left = all_left && turn > room;
    all_right = all_right && turn < -room;
  }
  return all_left || all_right;
}

ParitySearch::Passage ParitySearch::passage(const Seen& p, const Seen& q) const {
  const double margin = std::max(rim(p), rim(q));
  if (is_clear(p, q, margin)) return Passage::Clear;
  return is_clear(p, q, -margin) ? Passage::Unclear : Passage::Across;
}

/// Whether the edge crosses the ray from the first corner of the window in the direction of x. Edges meet in the same
/// projected vertices, so neighbours agree; edges of the patch's outline are clear of the corner.
bool ParitySearch::crosses_ray(const Seen& p, const Seen& q) const {
  const Seen& from = window_[0];
  if ((p.y > from.y) == (q.y > from.y)) return false;
  const Seen &low = p.y < q.y ? p : q, &high = p.y < q.y ? q : p;
  return (high.x - low.x) * (from.y - low.y) - (high.y - low.y) * (from.x - low.x) > 0;
}

bool ParitySearch::proves(const std::array<Vec3, 3>& triangle, const Piece& piece, std::uint32_t seed) {
  patch_.clear();
  if (!set_view(triangle, piece)) return false;
  ++round_;
  patch_.assign(1, seed);
  visited_[seed] = round_;
  bool odd = false;
  for (std::size_t i = 0; i < patch_.size(); ++i) {
    const std::uint32_t slot = patch_[i];
    if (!neighbours_.usable[slot]) return false;
    SeenTriangle corners;
    for (std::size_t k = 0; k < 3; ++k) corners[k] = see(b_.vertices[b_.corners[slot][k]]);
    if (!heights_hold(corners)) return false;
    for (std::size_t k = 0; k < 3; ++k) {
      const Seen &p = corners[k], &q = corners[(k + 1) % 3];
      if (crosses_ray(p, q)) odd = !odd;
      const Passage way = passage(p, q);
      if (way == Passage::Clear) continue;
      const std::uint32_t next = neighbours_.across[slot][k];
      if (way == Passage::Unclear || next == PatchNeighbours::boundary || patch_.size() == patch_limit_) return false;
      if (visited_[next] == round_) continue;
      visited_[next] = round_;
      patch_.push_back(next);
    }
  }
  if (odd) work_ += patch_.size();
  return odd;
}

}  // namespace meshbound
