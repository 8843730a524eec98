// SPDX-License-Identifier: MIT
#include "texture_proof/texture_search.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

namespace meshbound {
namespace {

using Polygon = Overlay::Polygon;

constexpr std::int64_t whole = std::int64_t{1} << 40U;
constexpr int max_depth = 36;             ///< twelve halvings of the weight of each corner
constexpr double first_precision = 1e-6;  ///< of the tolerance; what that cannot decide is computed exactly

/// Pieces into which what is not covered may fall; a verifier refuses more.
constexpr std::size_t max_rest = 256;

/// Triangles that a leaf names, as what it takes to check one grows with their square; but for small pieces, from four
/// halvings of each weight on, since a vertex may have any number of triangles around it.
constexpr std::size_t max_chosen = 64;
constexpr int depth_of_small_pieces = 12;

/// Nodes of the tree of a triangle, beside one for each candidate, after which the search ends: where the deviation
/// exceeds the tolerance, cuts go on without end.
constexpr std::size_t max_nodes = 4096;

/// In space, by the tolerance times this, triangles are far apart whatever rounding does.
constexpr double reach_growth = 1 + 1e-9;

}  // namespace

double TextureSearch::reach() const { return tolerance_ * reach_growth; }

/// Clips to the inside of a line, the line included; with `flip` to what lies strictly outside, with its border. False,
/// the polygon then being of no use, where nothing but a part of the polygon's border lies there. A triangle without
/// area in the texture may lie on a line as a whole: inside.
bool TextureSearch::clip(Polygon& polygon, Overlay::Line line, bool flip) {
  bool has_inside = false, has_outside = false;
  for (const Overlay::PolygonCorner& corner : polygon) {
    const int side = overlay_.side(line, corner.node);
    has_inside = has_inside || side > 0;
    has_outside = has_outside || side < 0;
  }
  if (flip ? !has_outside : has_outside && !has_inside) return false;
  overlay_.clip(polygon, line, flip, clipped_);
  std::swap(polygon, clipped_);
  return true;
}

/// Clips to what a candidate covers. False where that has no area.
bool TextureSearch::clip(Polygon& polygon, std::uint32_t candidate) {
  const auto lines = overlay_.lines_of(candidate);
  return std::all_of(lines.begin(), lines.end(), [&](Overlay::Line line) { return clip(polygon, line, false); });
}

/// Takes what a candidate covers away from each polygon. Returns whether that was anything.
bool TextureSearch::subtract(std::vector<Polygon>& rest, std::uint32_t candidate) {
  const auto lines = overlay_.lines_of(candidate);
  std::vector<Polygon> left;
  bool is_changed = false;
  for (Polygon& polygon : rest) {
    const std::size_t before = left.size();
    Polygon inside = polygon;
    const bool is_covered = std::all_of(lines.begin(), lines.end(), [&](Overlay::Line line) {
      Polygon beyond = inside;
      if (!clip(inside, line, false)) return false;
      if (clip(beyond, line, true)) left.push_back(std::move(beyond));
      return true;
    });
    is_changed = is_changed || is_covered;
    if (is_covered) continue;
    left.resize(before);
    left.push_back(std::move(polygon));
  }
  rest = std::move(left);
  return is_changed;
}

bool TextureSearch::is_near(const Overlay::Node& point, std::uint32_t candidate) {
  const Bounds rough = overlay_.distance(candidate, point, first_precision * tolerance_);
  if (rough.upper <= tolerance_ || rough.lower > tolerance_) return rough.upper <= tolerance_;
  return overlay_.distance(candidate, point, 0).upper <= tolerance_;
}

bool TextureSearch::cell_is_near(const Polygon& cell, std::uint32_t candidate) {
  return std::all_of(cell.begin(), cell.end(),
                     [&](const Overlay::PolygonCorner& corner) { return is_near(corner.node, candidate); });
}

/// Whether each corner has a candidate that covers it and is near there. No cut helps where one has none.
bool TextureSearch::is_near_at_corners(const Polygon& piece) {
  return std::all_of(piece.begin(), piece.end(), [&](const Overlay::PolygonCorner& corner) {
    for (std::uint32_t c = 0; c < overlay_.candidates(); ++c)
      if (is_far_[c] == 0 && overlay_.covers(c, corner.node) && is_near(corner.node, c)) return true;
    return false;
  });
}

/// Whether a candidate covers a part of the polygon that has an area.
bool TextureSearch::is_covered_in_part(const Polygon& polygon) {
  for (std::uint32_t c = 0; c < overlay_.candidates(); ++c)
    if (Polygon covered = polygon; clip(covered, c)) return true;
  return false;
}

/// Whether no triangle of the target has a point with the texture coordinate of a point of the piece.
bool TextureSearch::is_untouched(const Polygon& piece) {
  for (std::uint32_t c = 0; c < overlay_.candidates(); ++c) {
    Polygon covered;
    overlay_.clip(piece, c, covered);
    if (!covered.empty()) return false;
  }
  return true;
}

/// Names candidates while any of the piece is left: where what they cover of it is near, that is taken away from the
/// rest. False if there are too many of them, or too many parts of the rest.
bool TextureSearch::take(const Polygon& piece, const std::vector<std::uint32_t>& candidates, std::vector<Polygon>& rest,
                         std::vector<std::uint32_t>& chosen) {
  for (const std::uint32_t c : candidates) {
    if (rest.empty()) break;
    Polygon cell = piece;
    if (is_far_[c] != 0 || !clip(cell, c) || !cell_is_near(cell, c) || !subtract(rest, c)) continue;
    chosen.push_back(overlay_.candidate(c).source->triangle);
    if (chosen.size() > max_chosen_ || rest.size() > max_rest) return false;
  }
  return true;
}

/// The others are looked at where near candidates do not cover the piece.
bool TextureSearch::prove_leaf(const Polygon& piece, const std::vector<std::uint32_t>& near,
                               std::vector<std::uint32_t>& chosen) {
  std::vector<Polygon> rest = {piece};
  if (!take(piece, near, rest, chosen)) return false;
  if (rest.empty()) return true;
  add_others();
  if (!take(piece, others_, rest, chosen)) return false;
  if (rest.empty()) return true;
  if (const ChartTriangle& a = overlay_.triangle(); a.chart != Chart::Area) {
    if (!target_.seems_to_meet_without_area(a)) return chosen.empty() && is_untouched(piece);
    is_hopeless_ = !is_near_at_corners(piece);
    return false;
  }
  return std::none_of(rest.begin(), rest.end(), [&](const Polygon& polygon) { return is_covered_in_part(polygon); });
}

bool TextureSearch::prove(const Polygon& piece, const Range& range, int depth, std::vector<std::uint32_t> near,
                          std::vector<Node>& nodes) {
  Node leaf;
  max_chosen_ = depth < depth_of_small_pieces ? max_chosen : std::numeric_limits<std::size_t>::max();
  if (prove_leaf(piece, near, leaf.triangles)) {
    nodes.push_back(std::move(leaf));
    return true;
  }
  if (is_hopeless_ || depth == max_depth || nodes.size() - first_node_ > max_nodes + overlay_.candidates())
    return false;
  std::erase_if(near, [&](std::uint32_t c) {
    Polygon covered = piece;
    return !clip(covered, c);
  });
  nodes.push_back({true, {}});
  const auto corner = static_cast<std::size_t>(depth % 3);
  const std::int64_t half = range.size[corner] / 2;
  const Overlay::Line line = overlay_.add_level(corner, range.low[corner] + half);
  for (const bool is_upper : {false, true}) {
    Range part = range;
    part.size[corner] = half;
    if (is_upper) part.low[corner] += half;
    Polygon polygon = piece;
    if (!clip(polygon, line, !is_upper))
      nodes.emplace_back();
    else if (!prove(polygon, part, depth + 1, near, nodes))
      return false;
  }
  return true;
}

/// Adds those with an area in the texture as candidates.
void TextureSearch::add(const std::vector<const ChartTriangle*>& triangles) {
  const Eigen::AlignedBox3d place = place_of(*overlay_.triangle().source);
  for (const ChartTriangle* b : triangles) {
    if (b->chart != Chart::Area) continue;
    overlay_.add(*b);
    if (overlay_.candidates() > is_far_.size())
      is_far_.push_back(distance_between(place, place_of(*b->source)) > reach() ? 1 : 0);
  }
}

void TextureSearch::add_others() {
  if (std::exchange(has_others_, true)) return;
  const std::uint32_t first = overlay_.candidates();
  if (overlay_.triangle().chart == Chart::Area) target_.find_others(overlay_.triangle(), found_);
  add(found_.others);
  others_.resize(overlay_.candidates() - first);
  std::iota(others_.begin(), others_.end(), first);
}

bool TextureSearch::prove(const ChartTriangle& source, std::vector<Node>& nodes) {
  first_node_ = nodes.size();
  overlay_.begin(source);
  target_.find_candidates(source, reach(), found_);
  if (found_.copy && found_.copy->upper <= tolerance_) {
    nodes.push_back({false, {found_.copy->triangle->source->triangle}});
    return true;
  }
  is_far_.clear();
  has_others_ = false;
  others_.clear();
  is_hopeless_ = false;
  add(found_.near);
  std::vector<std::uint32_t> near(overlay_.candidates());
  std::iota(near.begin(), near.end(), 0U);
  return prove(overlay_.whole(), {{0, 0, 0}, {whole, whole, whole}}, 0, near, nodes);
}

}  // namespace meshbound
