// SPDX-License-Identifier: MIT
/// Boxes that lie along what they hold. A needle askew to the axes fills next to nothing of its box, and where there
/// are thousands of needles, their boxes hold any point near one of them: a query would test all triangles. What a node
/// holds mostly lies in one direction, as it is what follows one another along the curve. After Gottschalk, Lin and
/// Manocha, "OBBTree", SIGGRAPH 1996.
#pragma once
#include <vector>

#include "bvh/box_query.h"
#include "bvh/bvh_data.h"

namespace meshbound {

/// Where oriented boxes are of use: elsewhere boxes along the axes serve as well.
struct OrientedUse {
  /// More boxes of blocks than these hold a point of the mesh, in the mean,
  int max_boxes_at_point;
  /// and the areas of oriented ones are a smaller share than this of those.
  double max_share_of_areas;
};

/// By node of the tree; empty where they are of no use. O(n) there, and O(n log n) where they are.
[[nodiscard]] std::vector<OrientedNode> oriented_nodes(const Bvh::Data& data, const OrientedUse& use);

/// Fills `data.oriented` unless another thread has done so, which it waits for.
void make_oriented_nodes(const Bvh::Data& data);

/// Those for queries, which are kept with the tree.
inline const std::vector<OrientedNode>& oriented_nodes(const Bvh::Data& data) {
  if (!data.oriented.made.load(std::memory_order_acquire)) make_oriented_nodes(data);
  return data.oriented.nodes;
}

inline namespace MESHBOUND_ISA {

/// A point in the frame of a node. Misses the exact one by less than 2^-50 of its distance from the centre, along each
/// axis: three roundings of products, two of sums, one of the difference.
inline Vec3 in_frame_of(const OrientedNode& node, const Vec3& p) {
  const Vec3 from_centre = p - node.centre;
  return {dot(node.axes[0], from_centre), dot(node.axes[1], from_centre), dot(node.axes[2], from_centre)};
}

/// A query point that is not far, for oriented boxes; asked for nodes of the tree. That rotations are not exact, by
/// 2^-42 (`oriented_nodes.cpp`), is covered by what `prune_limit` allows for.
class OrientedQuery {
 public:
  OrientedQuery(const Bvh::Data& data, const std::vector<OrientedNode>& oriented, const Vec3& p)
      : nodes_(data.nodes.data()), oriented_(oriented.data()), p_(p) {}

  [[nodiscard]] BoxDistances to_boxes(const BvhNode& node) const {
    const OrientedNode& oriented = oriented_[&node - nodes_];
    const Vec3 local = in_frame_of(oriented, p_), room{rounding, rounding, rounding};
    return FloatQuery(local - room, local + room).to_boxes(oriented.children);
  }
  [[nodiscard]] static float limit(double squared) { return prune_limit(squared); }

 private:
  static constexpr double rounding = 2 * max_near_magnitude * 0x1p-50;

  const BvhNode* nodes_;
  const OrientedNode* oriented_;
  Vec3 p_;
};

}  // namespace MESHBOUND_ISA
}  // namespace meshbound
