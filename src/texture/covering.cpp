// SPDX-License-Identifier: MIT
#include "texture/covering.h"

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

namespace meshbound {
namespace {

bool is_before(const Eigen::Vector2d& p, const Eigen::Vector2d& q) {
  return std::tie(p.x(), p.y()) < std::tie(q.x(), q.y());
}

/// Whether all of the triangle that the overlay is of lies on one side of a line, or on it.
bool is_on_one_side(Overlay& overlay, Overlay::Line line, const Overlay::Polygon& whole) {
  bool has_left = false, has_right = false;
  for (const auto& corner : whole) {
    const int side = overlay.side(line, corner.node);
    has_left = has_left || side > 0;
    has_right = has_right || side < 0;
  }
  return !has_left || !has_right;
}

/// Whether a coordinate is known to lie on an edge of a triangle or beyond it; edge k is opposite to corner k.
bool is_beyond(const ChartTriangle& t, std::size_t k, const Eigen::Vector2d& p) {
  const Eigen::Vector2d &from = t.source->coordinates[(k + 1) % 3], &to = t.source->coordinates[(k + 2) % 3];
  if (p == from || p == to) return true;
  const auto way = [&](const Eigen::Vector2d& q, Eigen::Index axis) {
    return Approximate{q[axis], 0} - Approximate{from[axis], 0};
  };
  const Approximate area = way(to, 0) * way(p, 1) - way(to, 1) * way(p, 0);
  int sign = 0;
  return sign_is_known(area, sign) && (t.turned ? sign >= 0 : sign <= 0);
}

/// Whether a segment is known to have no point inside a triangle, by an edge that it lies beyond.
bool is_segment_beyond(const ChartTriangle& t, const Eigen::Vector2d& p, const Eigen::Vector2d& q) {
  for (std::size_t k = 0; k < 3; ++k)
    if (is_beyond(t, k, p) && is_beyond(t, k, q)) return true;
  return false;
}

/// Inner points of A, by their weights, to be tried in turn: a point on an edge of a candidate decides nothing.
constexpr std::array<std::array<double, 3>, 3> inner_points = {{{1, 1, 1}, {3, 2, 1}, {1, 3, 5}}};

bool has_inner_point(Overlay& overlay, std::uint32_t candidate) {
  return std::any_of(inner_points.begin(), inner_points.end(), [&](const std::array<double, 3>& weights) {
    const Overlay::Node node = Overlay::given(weights);
    const auto lines = overlay.lines_of(candidate);
    return std::all_of(lines.begin(), lines.end(), [&](Overlay::Line line) { return overlay.side(line, node) > 0; });
  });
}

}  // namespace

/// Adds the edges of a candidate that may run through the inside of A.
void Covering::add_edges(Overlay& overlay, std::uint32_t candidate) {
  const ChartTriangle& b = overlay.candidate(candidate);
  const auto lines = overlay.lines_of(candidate);
  const Overlay::Polygon whole = overlay.whole();
  for (std::size_t k = 0; k < 3; ++k) {  // line k lies opposite to corner k
    if (is_on_one_side(overlay, lines[k], whole)) continue;
    const Eigen::Vector2d *from = &b.source->coordinates[(k + 1) % 3], *to = &b.source->coordinates[(k + 2) % 3];
    if (is_segment_beyond(overlay.triangle(), *from, *to)) continue;
    const bool is_forth = is_before(*from, *to);
    if (!is_forth) std::swap(from, to);
    edges_.push_back({from, to, is_forth != b.turned ? 1 : -1});
  }
}

bool Covering::do_edges_cancel() {
  const auto key = [](const Edge& e) { return std::tie(e.from->x(), e.from->y(), e.to->x(), e.to->y()); };
  std::sort(edges_.begin(), edges_.end(), [&](const Edge& e, const Edge& f) { return key(e) < key(f); });
  for (auto first = edges_.begin(); first != edges_.end();) {
    int sum = 0;
    auto end = first;
    for (; end != edges_.end() && key(*end) == key(*first); ++end) sum += end->direction;
    if (sum != 0) return false;
    first = end;
  }
  return true;
}

bool Covering::is_complete(Overlay& overlay, std::span<const std::uint32_t> candidates) {
  edges_.clear();
  for (const std::uint32_t c : candidates) add_edges(overlay, c);
  return do_edges_cancel() && std::any_of(candidates.begin(), candidates.end(),
                                          [&](std::uint32_t c) { return has_inner_point(overlay, c); });
}

}  // namespace meshbound
