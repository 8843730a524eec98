// SPDX-License-Identifier: MIT
#include "texture/covering.h"

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

#include "texture/chart_sides.h"

namespace meshbound {
namespace {

bool is_before(const Eigen::Vector2d& p, const Eigen::Vector2d& q) {
  return std::tie(p.x(), p.y()) < std::tie(q.x(), q.y());
}

Overlay::Node inner_point(const Overlay::Polygon& piece, const std::array<double, 3>& weights_of_first) {
  std::array<double, 3> weights{};
  for (std::size_t k = 0; k < piece.size(); ++k) {
    const std::array<double, 3> corner = Overlay::rounded(piece[k].node);
    for (std::size_t i = 0; i < 3; ++i) weights[i] += (k < 3 ? weights_of_first[k] : 1) * corner[i];
  }
  return Overlay::given(weights);
}

/// Whether some candidate has the point inside. Absent if none has, but the point lies on the border of one.
std::optional<bool> is_in_some(Overlay& overlay, Covering::Candidates candidates, const Overlay::Node& point) {
  bool is_on_border = false;
  for (const std::uint32_t c : candidates) {
    int lowest = 1;
    for (const Overlay::Line line : overlay.lines_of(c)) {
      lowest = std::min(lowest, overlay.side(line, point));
      if (lowest < 0) break;
    }
    if (lowest > 0) return true;
    is_on_border = is_on_border || lowest == 0;
  }
  return is_on_border ? std::nullopt : std::optional(false);
}

/// Whether the candidates cover the inside of a piece that no open edge runs through; else they cover no area of it.
/// Absent where no point decides that.
std::optional<bool> is_covered(Overlay& overlay, Covering::Candidates candidates, const Overlay::Polygon& piece) {
  for (const std::array<double, 3>& weights : weights_of_inner_points) {
    const Overlay::Node point = inner_point(piece, weights);
    if (!overlay.is_inside(piece, point)) continue;
    if (const auto is_in = is_in_some(overlay, candidates, point)) return is_in;
  }
  return std::nullopt;
}

/// Whether an edge has no point inside the piece because both its ends lie beyond a line of the border, or on it.
bool is_beyond(Overlay& overlay, const Overlay::Polygon& piece, const std::array<Overlay::Node, 2>& ends) {
  return std::any_of(piece.begin(), piece.end(), [&](const Overlay::PolygonCorner& corner) {
    const int inner = overlay.inner_side(corner.to_next, piece);
    return std::all_of(ends.begin(), ends.end(),
                       [&](const Overlay::Node& end) { return overlay.side(corner.to_next, end) * inner <= 0; });
  });
}

/// Open edges along which a triangle is cut. A triangle at the border of a coarse chart has some ten.
constexpr std::size_t max_open_edges = 64;

}  // namespace

/// Whether an edge runs between two of the candidates, one on each side of it.
bool Covering::cancels(const Overlay& overlay, const ChartTriangle* across) const {
  if (across == nullptr) return false;
  const auto candidate = overlay.number_of(*across);
  return candidate && is_counted_[*candidate] != 0;
}

/// Adds the edges of a candidate that may run through the inside of A, but those that are known to cancel.
void Covering::add_edges(Overlay& overlay, std::uint32_t candidate) {
  const ChartTriangle& b = overlay.candidate(candidate);
  const auto lines = overlay.lines_of(candidate);
  for (std::uint32_t k = 0; k < 3; ++k) {  // line k lies opposite to corner k
    if (cancels(overlay, b.across[k]) || overlay.is_on_one_side(lines[k], overlay.whole())) continue;
    const Eigen::Vector2d *from = &b.source->coordinates[(k + 1) % 3], *to = &b.source->coordinates[(k + 2) % 3];
    if (is_outside(overlay.triangle(), *from, *to)) continue;
    const bool is_forth = is_before(*from, *to);
    if (!is_forth) std::swap(from, to);
    edges_.push_back({from, to, is_forth != b.turned ? 1 : -1, candidate, k});
  }
}

/// Leaves one edge for each segment that more edges run along one way than the other: the first of them.
void Covering::drop_edges_that_cancel() {
  const auto key = [](const Edge& e) { return std::tie(e.from->x(), e.from->y(), e.to->x(), e.to->y()); };
  std::sort(edges_.begin(), edges_.end(), [&](const Edge& e, const Edge& f) {
    return key(e) != key(f) ? key(e) < key(f) : e.candidate < f.candidate;
  });
  std::size_t open = 0;
  for (std::size_t first = 0; first < edges_.size();) {
    int sum = 0;
    std::size_t end = first;
    for (; end < edges_.size() && key(edges_[end]) == key(edges_[first]); ++end) sum += edges_[end].direction;
    if (sum != 0) edges_[open++] = edges_[first];
    first = end;
  }
  edges_.resize(open);
}

void Covering::find_open_edges(Overlay& overlay, Candidates candidates) {
  edges_.clear();
  is_counted_.assign(overlay.candidates(), 0);
  for (const std::uint32_t c : candidates) is_counted_[c] = 1;
  for (const std::uint32_t c : candidates) add_edges(overlay, c);
  drop_edges_that_cancel();
}

/// Cuts the pieces that an edge may run through along its line.
void Covering::cut(Overlay& overlay, const Edge& edge) {
  const std::array<Overlay::Node, 2> ends = {overlay.corner_of(edge.candidate, (edge.number + 1) % 3),
                                             overlay.corner_of(edge.candidate, (edge.number + 2) % 3)};
  const Overlay::Line line = overlay.lines_of(edge.candidate)[edge.number];
  halves_.clear();
  for (Overlay::Polygon& piece : pieces_) {
    if (overlay.is_on_one_side(line, piece) || is_beyond(overlay, piece, ends)) {
      halves_.push_back(std::move(piece));
      continue;
    }
    for (const bool flip : {false, true}) overlay.clip(piece, line, flip, halves_.emplace_back());
  }
  std::swap(pieces_, halves_);
}

std::optional<std::vector<Overlay::Polygon>> Covering::uncovered(Overlay& overlay, Candidates candidates) {
  find_open_edges(overlay, candidates);
  if (edges_.size() > max_open_edges) return std::nullopt;
  pieces_.assign(1, overlay.whole());
  for (const Edge& edge : edges_) cut(overlay, edge);
  std::vector<Overlay::Polygon> found;
  for (Overlay::Polygon& piece : pieces_) {
    const auto covered = is_covered(overlay, candidates, piece);
    if (!covered) return std::nullopt;
    if (!*covered) found.push_back(std::move(piece));
  }
  return found;
}

}  // namespace meshbound
