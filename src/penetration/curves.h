// SPDX-License-Identifier: MIT
/// The curves in which the surfaces of two placed models cross, by what crosses what: which edge goes through which
/// triangle, in which order along the edge, and how these nodes are joined inside the triangles.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "numeric/no_index.h"
#include "numeric/rounding.h"
#include "penetration/contact.h"
#include "penetration/placed_pair.h"

namespace meshbound {

/// Where an edge of one side passes through a triangle of the other. Three triangles meet there: the two at the edge
/// (slots 0 and 1, as in `ModelEdge`) and the one passed through (slot 2).
struct CurveNode {
  std::uint32_t side = 0;      ///< of the edge
  std::uint32_t edge = 0;      ///< index in the model of `side`
  std::uint32_t triangle = 0;  ///< index in the other model
  bool leaves = false;         ///< seen from its first vertex, the edge leaves the other model here
  std::uint32_t rank = 0;      ///< position in `EdgeNodes` of the edge
  /// By slot: the segment that begins here in that triangle; `no_index` if one ends here.
  std::array<std::uint32_t, 3> next{no_index, no_index, no_index};
  /// By slot: the cycle around a piece of that triangle that passes here (pieces.h).
  std::array<std::uint32_t, 3> cycle{no_index, no_index, no_index};
  Vec3 position;     ///< local
  double error = 0;  ///< `position` is at most this far from the node, local
};

/// The segment in which a triangle of side 0 and one of side 1 meet. In the triangle of side 0, seen against its
/// normal, the inside of side 1 is on the left on the way from `ends[0]` to `ends[1]`; in the triangle of side 1 the
/// inside of side 0 is on the left on the way back.
struct CurveSegment {
  std::array<std::uint32_t, 2> triangles{};  ///< by side
  std::array<std::uint32_t, 2> ends{};       ///< nodes

  [[nodiscard]] std::uint32_t begin(std::uint32_t side) const { return ends[side]; }
  [[nodiscard]] std::uint32_t end(std::uint32_t side) const { return ends[1 - side]; }
};

/// The exact position of a point: numerator / denominator, the latter positive, in the unit of `PlacedPair::exact`.
struct ExactNode {
  ExactPoint numerator;
  mpz_class denominator;
};

/// The largest distance of `PlacedPair::to_local` of an exact position from that position, local: 3 units in the last
/// place of coordinates of magnitude 1 at most.
inline constexpr double rounded_error = 8 * unit_roundoff;

/// A corner of the intersection of two triangles of one plane.
struct FlushCorner {
  ExactNode exact;
  Vec3 position;  ///< local, off by at most `rounded_error`
};

class CrossingCurves {
 public:
  /// Finds all nodes and segments. `pair` must have been placed. A node whose position in doubles may be off by more
  /// than `node_error`, local, is computed from integers.
  void find(PlacedPair& pair, double node_error);

  std::vector<CurveNode> nodes;
  std::vector<CurveSegment> segments;
  std::array<std::vector<std::uint32_t>, 2> crossed;  ///< by side: triangles with segments, ascending
  /// Triangles of side 0 and 1 that lie in one plane, have normals to the same side and boxes that overlap.
  std::vector<std::array<std::uint32_t, 2>> flush_pairs;
  std::vector<FlushCorner> flush_corners;  ///< filled by `FlushFaces`
  PairCounters counters;

  /// Segments in a triangle; empty if no curve crosses it.
  [[nodiscard]] std::span<const std::uint32_t> segments_in(std::uint32_t side, std::uint32_t triangle) const;
  /// Nodes on an edge, from its first vertex to its second.
  [[nodiscard]] std::span<const std::uint32_t> nodes_on(std::uint32_t side, std::uint32_t edge) const;

 private:
  struct Range {
    std::uint32_t begin = 0, end = 0;
  };

  void cross(PlacedPair& pair, std::uint32_t s, std::uint32_t t);
  void note_if_flush(PlacedPair& pair, std::uint32_t s, std::uint32_t t);
  std::uint32_t node(std::uint32_t side, std::uint32_t edge, std::uint32_t triangle, bool leaves);
  void link(const PlacedPair& pair, std::uint32_t segment);
  void group_segments(const PlacedPair& pair);
  void group_nodes(PlacedPair& pair);

  std::unordered_map<std::uint64_t, std::uint32_t> node_at_;
  BoxPairMemory box_pairs_;
  std::array<std::vector<std::uint32_t>, 2> segment_order_;
  std::array<SparseArray<Range>, 2> segment_ranges_;
  std::vector<std::uint32_t> node_order_;
  std::array<SparseArray<Range>, 2> node_ranges_;
};

/// The slot of a triangle at a node that lies on one of its edges.
[[nodiscard]] inline std::size_t slot_at_edge(const ClosedModel::Data& model, const CurveNode& node,
                                              std::uint32_t triangle) {
  return model.edges[node.edge].triangle[0] == triangle ? 0 : 1;
}

[[nodiscard]] ExactNode exact_position(PlacedPair& pair, const CurveNode& node);

/// Sets `position` and `error`; computes them from integers if doubles are off by more than `max_error`, local.
void set_position(PlacedPair& pair, double max_error, CurveNode& node);

/// Whether node `a` comes before node `b` on the edge that both lie on, from its first vertex on.
[[nodiscard]] bool comes_before(PlacedPair& pair, const CurveNode& a, const CurveNode& b);

}  // namespace meshbound
