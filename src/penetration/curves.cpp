// SPDX-License-Identifier: MIT
#include "penetration/curves.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <tuple>

namespace meshbound {
namespace {

bool all_equal(const std::array<int, 3>& signs) { return signs[0] == signs[1] && signs[1] == signs[2]; }

}  // namespace

void CrossingCurves::find(PlacedPair& pair, double node_error) {
  nodes.clear();
  segments.clear();
  flush_pairs.clear();
  flush_corners.clear();
  node_at_.clear();
  counters = {};
  visit_triangle_pairs(pair, box_pairs_, counters, [&](std::uint32_t s, std::uint32_t t) {
    cross(pair, s, t);
    return true;
  });
  for (std::uint32_t i = 0; i < segments.size(); ++i) link(pair, i);
  group_segments(pair);
  for (CurveNode& node : nodes) {
    pair.count_step();
    set_position(pair, node_error, node);
  }
  group_nodes(pair);
}

/// Adds what two triangles have in common: nothing or, in general position, a segment between two nodes.
void CrossingCurves::cross(PlacedPair& pair, std::uint32_t s, std::uint32_t t) {
  const std::array<Triangle, 2> corners{pair.model(0).triangles[s], pair.model(1).triangles[t]};
  std::array<std::array<int, 3>, 2> signs;  // by side: of its corners against the plane of the other
  const std::uint64_t perturbed = pair.perturbed_decisions();
  signs[0] = pair.sides_of_plane(1, corners[1], corners[0]);
  if (all_equal(signs[0])) {
    if (pair.perturbed_decisions() == perturbed + 3) note_if_flush(pair, s, t);
    return;
  }
  signs[1] = pair.sides_of_plane(0, corners[0], corners[1]);
  if (all_equal(signs[1])) return;
  CurveSegment segment{{s, t}, {no_index, no_index}};
  for (std::uint32_t side = 0; side < 2; ++side) {
    const ClosedModel::Data& model = pair.model(side);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t next = next_corner(k);
      if (signs[side][k] == signs[side][next]) continue;
      if (!pair.goes_through(1 - side, corners[1 - side], corners[side][k], corners[side][next])) continue;
      const bool goes_out = signs[side][k] < 0;  // the corner where it begins lies against the normal: inside
      const std::uint32_t edge = model.edges_of[segment.triangles[side]][k];
      const bool runs_along = model.edges[edge].triangle[0] == segment.triangles[side];
      // Where an edge of side 0 leaves the other model, the inside is behind it: on the left of the direction into the
      // triangle.
      segment.ends[(side == 0) == goes_out ? 0 : 1] =
          node(side, edge, segment.triangles[1 - side], goes_out == runs_along);
    }
  }
  if (segment.ends[0] == no_index && segment.ends[1] == no_index) return;
  if (segment.ends[0] == no_index || segment.ends[1] == no_index)
    throw std::logic_error("two triangles cross in a segment with one end");
  segments.push_back(segment);
}

/// Notes two triangles of one plane whose normals point to the same side.
void CrossingCurves::note_if_flush(PlacedPair& pair, std::uint32_t s, std::uint32_t t) {
  const auto normal = [&pair](std::uint32_t side, const Triangle& corners) {
    const ExactPoint& p = pair.exact({side, corners[0]});
    return meshbound::cross(pair.exact({side, corners[1]}) - p, pair.exact({side, corners[2]}) - p);
  };
  if (sgn(dot(normal(0, pair.model(0).triangles[s]), normal(1, pair.model(1).triangles[t]))) > 0)
    flush_pairs.push_back({s, t});
}

std::uint32_t CrossingCurves::node(std::uint32_t side, std::uint32_t edge, std::uint32_t triangle, bool leaves) {
  const std::uint64_t key = std::uint64_t{side} << 63 | std::uint64_t{edge} << 32 | triangle;
  const auto [found, is_new] = node_at_.try_emplace(key, static_cast<std::uint32_t>(nodes.size()));
  if (is_new) {
    CurveNode& added = nodes.emplace_back();
    added.side = side;
    added.edge = edge;
    added.triangle = triangle;
    added.leaves = leaves;
  }
  return found->second;
}

void CrossingCurves::link(const PlacedPair& pair, std::uint32_t segment) {
  for (std::uint32_t side = 0; side < 2; ++side) {
    CurveNode& begin = nodes[segments[segment].begin(side)];
    const std::size_t slot =
        begin.side == side ? slot_at_edge(pair.model(side), begin, segments[segment].triangles[side]) : 2;
    begin.next[slot] = segment;
  }
}

void CrossingCurves::group_segments(const PlacedPair& pair) {
  for (std::uint32_t side = 0; side < 2; ++side) {
    std::vector<std::uint32_t>& order = segment_order_[side];
    order.resize(segments.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
      return std::tie(segments[a].triangles[side], a) < std::tie(segments[b].triangles[side], b);
    });
    segment_ranges_[side].clear(pair.model(side).triangles.size());
    crossed[side].clear();
    for (std::uint32_t i = 0; i < order.size(); ++i) {
      const std::uint32_t triangle = segments[order[i]].triangles[side];
      if (!segment_ranges_[side].has(triangle)) {
        segment_ranges_[side].set(triangle, {i, i});
        crossed[side].push_back(triangle);
      }
      segment_ranges_[side][triangle].end = i + 1;
    }
  }
}

void CrossingCurves::group_nodes(PlacedPair& pair) {
  node_order_.resize(nodes.size());
  for (std::uint32_t i = 0; i < node_order_.size(); ++i) node_order_[i] = i;
  std::sort(node_order_.begin(), node_order_.end(), [&](std::uint32_t i, std::uint32_t j) {
    const CurveNode &a = nodes[i], &b = nodes[j];
    if (a.side != b.side) return a.side < b.side;
    if (a.edge != b.edge) return a.edge < b.edge;
    pair.count_step();
    return i != j && comes_before(pair, a, b);
  });
  for (std::uint32_t side = 0; side < 2; ++side) node_ranges_[side].clear(pair.model(side).edges.size());
  for (std::uint32_t i = 0; i < node_order_.size(); ++i) {
    CurveNode& node = nodes[node_order_[i]];
    auto& ranges = node_ranges_[node.side];
    if (!ranges.has(node.edge)) ranges.set(node.edge, {i, i});
    node.rank = i - ranges[node.edge].begin;
    ranges[node.edge].end = i + 1;
  }
}

std::span<const std::uint32_t> CrossingCurves::segments_in(std::uint32_t side, std::uint32_t triangle) const {
  if (!segment_ranges_[side].has(triangle)) return {};
  const Range range = segment_ranges_[side][triangle];
  return std::span(segment_order_[side]).subspan(range.begin, range.end - range.begin);
}

std::span<const std::uint32_t> CrossingCurves::nodes_on(std::uint32_t side, std::uint32_t edge) const {
  if (!node_ranges_[side].has(edge)) return {};
  const Range range = node_ranges_[side][edge];
  return std::span(node_order_).subspan(range.begin, range.end - range.begin);
}

}  // namespace meshbound
