// SPDX-License-Identifier: MIT
#include "simplify/cover/forward_cover.h"

#include <algorithm>
#include <bit>

namespace meshbound {
namespace {

/// Pieces shorter than this share of the tolerance are not cut further: between points that close, a face that holds
/// one and not the other is at the tolerance, and a cover that needs it is too tight to look for.
constexpr double shortest_edge_share = 1e-3;

/// Cuts keep away from the ends, so that pieces shrink.
constexpr double nearest_cut = 0.05;

/// An edge whose ends share a face is cut only when the others do too: it weighs as if it were this much shorter.
constexpr double held_edge_weight = 1e-3;

/// Up to so many candidates are asked as fast all at once as one after another.
constexpr int few_candidates = 16;

/// Vertices whose masks are kept: those of the originals below a star, which follow one another. A power of two.
constexpr std::size_t cached_vertices = 1024;

FaceMask lowest(FaceMask mask) { return mask & (~mask + 1); }

}  // namespace

ForwardCover::ForwardCover(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles)
    : vertices_(vertices), triangles_(triangles), cache_(cached_vertices) {}

void ForwardCover::begin(double tolerance) {
  candidates_.clear(tolerance);
  const double shortest = shortest_edge_share * tolerance;
  shortest_squared_edge_ = shortest * shortest;
  last_ = 0;
  if (++round_ != 0) return;
  cache_.assign(cached_vertices, {});  // of another round of that number
  round_ = 1;
}

void ForwardCover::add(const TriangleCorners& corners, std::uint32_t face) {
  if (size() == CandidateFaces::capacity) return;
  faces_[static_cast<std::size_t>(size())] = face;
  candidates_.add(corners);
}

FaceMask ForwardCover::holding(std::uint32_t vertex, FaceMask allowed) {
  CachedMask& cached = cache_[vertex % cached_vertices];
  if (cached.round != round_ || cached.vertex != vertex) cached = {round_, vertex, 0, 0};
  if (const FaceMask missing = allowed & ~cached.known; missing != 0) {
    cached.mask |= candidates_.holding(vertices_[vertex], missing);
    cached.known |= missing;
  }
  return cached.mask & allowed;
}

bool ForwardCover::are_corners_near(std::uint32_t triangle, FaceMask allowed) {
  for (const std::uint32_t v : triangles_[triangle]) {
    if (holding(v, allowed) != 0) continue;
    lost_point_ = vertices_[v];
    return false;
  }
  return true;
}

FaceMask ForwardCover::cover_whole(std::uint32_t triangle, FaceMask allowed) {
  const auto& t = triangles_[triangle];
  const auto holding_all = [&](FaceMask among) {
    return holding(t[0], among) & holding(t[1], among) & holding(t[2], among);
  };
  if (size() > few_candidates)
    if (const FaceMask common = holding_all(last_ & allowed); common != 0) return common;
  const FaceMask common = holding_all(allowed);
  return last_ = lowest(common);
}

FaceMask ForwardCover::hold_all(std::span<const std::uint32_t> vertices, FaceMask allowed) {
  const auto at = [&](std::size_t i) { return vertices_[vertices[i]]; };
  const auto holds = [&](FaceMask one) { return candidates_.holds_all(std::countr_zero(one), vertices.size(), at); };
  if (const FaceMask one = last_ & allowed; one != 0 && holds(one)) return one;
  FaceMask likely = holding(vertices.front(), allowed) & holding(vertices.back(), allowed) & ~last_;
  for (; likely != 0; likely &= likely - 1)
    if (holds(lowest(likely))) return last_ = lowest(likely);
  return 0;
}

FaceMask ForwardCover::cover(std::uint32_t triangle, FaceMask allowed) {
  const FaceMask one = cover_whole(triangle, allowed);
  return one != 0 ? one : cover_in_pieces(triangle, allowed, max_cuts);
}

FaceMask ForwardCover::cover_thoroughly(std::uint32_t triangle, FaceMask allowed) {
  const auto& t = triangles_[triangle];
  const FaceMask common = holding(t[0], allowed) & holding(t[1], allowed) & holding(t[2], allowed);
  if (common == 0) return cover_in_pieces(triangle, allowed, few_cuts);
  if (common == lowest(common)) return common;
  return candidates_.nearest((1.0 / 3) * (vertices_[t[0]] + vertices_[t[1]] + vertices_[t[2]]), common);
}

FaceMask ForwardCover::cover_in_pieces(std::uint32_t triangle, FaceMask allowed, int cuts) {
  const auto& t = triangles_[triangle];
  Piece whole;
  for (std::size_t i = 0; i < 3; ++i) {
    whole.corners[i] = vertices_[t[i]];
    whole.masks[i] = holding(t[i], allowed);
    if (whole.masks[i] == 0) return 0;
  }
  const FaceMask pieces = cover_in_pieces(whole, allowed, Asked::LikelyOnes, cuts);
  // A point that no candidate holds is lost, whoever is asked on the way to it.
  return pieces != 0 || lost_point_ ? pieces : cover_in_pieces(whole, allowed, Asked::All, cuts);
}

std::optional<FaceMask> ForwardCover::cover_sub_triangle(const TriangleCorners& corners, int depth) {
  const FaceMask all = first(size());
  Piece whole;
  whole.depth = depth;
  for (std::size_t i = 0; i < 3; ++i) {
    whole.corners[i] = corners[i];
    whole.masks[i] = candidates_.holding(corners[i], all);
    if (whole.masks[i] == 0) return std::nullopt;
  }
  return cover_in_pieces(whole, all, Asked::All, max_cuts);
}

FaceMask ForwardCover::cover_in_pieces(const Piece& whole, FaceMask allowed, Asked asked, int cuts) {
  open_.assign(1, whole);
  lost_point_.reset();
  FaceMask used = 0;
  for (int spent = 0; !open_.empty();) {
    const Piece piece = open_.back();
    open_.pop_back();
    const FaceMask common = piece.masks[0] & piece.masks[1] & piece.masks[2];
    if (common != 0) {
      if ((common & used) == 0) used |= lowest(common);
      continue;
    }
    if (++spent > cuts || piece.depth == deepest_cut || !cut(piece, allowed, asked)) return 0;
  }
  return used;
}

bool ForwardCover::cut(const Piece& piece, FaceMask allowed, Asked asked) {
  std::size_t from = 0;
  double longest = -1, squared = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const double edge = squared_length(piece.corners[j] - piece.corners[i]);
    const double weight = (piece.masks[i] & piece.masks[j]) != 0 ? held_edge_weight * edge : edge;
    if (weight > longest) longest = weight, squared = edge, from = i;
  }
  if (squared < shortest_squared_edge_) return false;
  const std::size_t to = (from + 1) % 3;
  const Vec3 p = piece.corners[from], q = piece.corners[to];
  double share = 0.5;
  if ((piece.masks[from] & piece.masks[to]) == 0) {
    const Reach reach = candidates_.reach(p, q, piece.masks[from], piece.masks[to]);
    share = std::clamp((reach.forth + 1 - reach.back) / 2, nearest_cut, 1 - nearest_cut);
  }
  const Vec3 middle = p + share * (q - p);
  // A candidate that holds no corner holds no part that is cut here, unless it is smaller than the piece: it is asked
  // only when the others fail.
  const FaceMask likely = asked == Asked::All ? allowed : piece.masks[0] | piece.masks[1] | piece.masks[2];
  FaceMask mask = candidates_.holding(middle, likely);
  if (mask == 0) mask = candidates_.holding(middle, allowed & ~likely);
  if (mask == 0) {
    lost_point_ = middle;
    return false;
  }
  const std::size_t other = 3 - from - to;
  const Vec3 apex = piece.corners[other];
  const FaceMask at_apex = piece.masks[other], at_from = piece.masks[from], at_to = piece.masks[to];
  open_.push_back({{p, middle, apex}, {at_from, mask, at_apex}, piece.depth + 1});
  open_.push_back({{middle, q, apex}, {mask, at_to, at_apex}, piece.depth + 1});
  return true;
}

}  // namespace meshbound
