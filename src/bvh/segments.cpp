// SPDX-License-Identifier: MIT
/// Triangles that are segments: two of their corners have one position. Edges lead from such a triangle to others that
/// have a whole edge in common with it, so a walk along a chain of segments goes by their ends.
#include <algorithm>
#include <cstdint>
#include <tuple>
#include <vector>

#include "bvh/build.h"
#include "geometry/position_table.h"

namespace meshbound {
namespace {

/// An end of a segment, and the entry of `Bvh::Data::neighbours` where the segments that go on from there are found.
struct SegmentEnd {
  PositionKey position;
  std::uint32_t slot, edge;

  friend bool operator<(const SegmentEnd& x, const SegmentEnd& y) {
    return std::tie(x.position, x.slot, x.edge) < std::tie(y.position, y.slot, y.edge);
  }
};

/// The edge without length of a triangle that is a segment; 3 for all others.
std::uint32_t edge_without_length(const Bvh::Data& data, std::uint32_t slot) {
  if (data.normals[slot] != std::array<float, 3>{}) return 3;
  const Triangle& t = data.corners[slot];
  const auto joins_one_position = [&](std::uint32_t k) {
    return same_position(data.vertices[t[k]], data.vertices[t[(k + 1) % 3]]);
  };
  if (joins_one_position(0)) return 3;  // the longest edge: the triangle is a point
  return joins_one_position(1) ? 1 : joins_one_position(2) ? 2 : 3;
}

/// The two ends of all segments. Each is noted at the edge that begins there: of the two edges at the doubled corner,
/// at the one without length.
std::vector<SegmentEnd> segment_ends(Bvh::Data& data) {
  std::vector<SegmentEnd> ends;
  for (std::uint32_t slot = 0; slot < data.triangle_count(); ++slot) {
    const std::uint32_t edge = edge_without_length(data, slot);
    if (edge == 3) continue;
    for (const std::uint32_t k : {edge, (edge + 2) % 3})
      ends.push_back({position_key(data.vertices[data.corners[slot][k]]), slot, k});
    // Both long edges join the same vertices, and mostly each has found the other.
    if (Neighbour& back = data.neighbours[slot][(edge + 1) % 3]; back.slot == slot) back = {};
  }
  std::sort(ends.begin(), ends.end());
  return ends;
}

}  // namespace

void link_segments(Bvh::Data& data) {
  const std::vector<SegmentEnd> ends = segment_ends(data);
  for (auto first = ends.begin(); first != ends.end();) {
    const auto behind =
        std::find_if(first, ends.end(), [&](const SegmentEnd& end) { return end.position != first->position; });
    for (auto end = first; end != behind; ++end) {
      const auto next = end + 1 == behind ? first : end + 1;
      Neighbour& across = data.neighbours[end->slot][end->edge];
      if (across.slot == no_slot || across.slot == end->slot)
        across = next->slot == end->slot ? Neighbour{} : Neighbour{next->slot & no_slot, 0};
    }
    first = behind;
  }
}

}  // namespace meshbound
