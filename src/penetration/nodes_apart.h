// SPDX-License-Identifier: MIT
/// Nodes of a tree whose triangles do not meet, where boxes along the axes cannot tell: needles askew to the axes fill
/// next to nothing of theirs, and around a hub, such as the middle of a cylinder's cap, all boxes meet.
#pragma once
#include <cstdint>
#include <vector>

#include "bvh/bvh_data.h"
#include "numeric/no_index.h"
#include "penetration/box_pairs.h"
#include "penetration/closed_model_data.h"

namespace meshbound {

/// Tells nodes of the tree of one model apart where the model is compared with itself. Any number of threads may ask.
class NodesApart {
 public:
  /// `model` must outlive this. O(n), and O(n log n) where it is full of needles.
  explicit NodesApart(const ClosedModel::Data& model);

  /// Whether surely no triangle below the one node has a point in common with one below the other, but for a vertex
  /// that both have. O(1).
  [[nodiscard]] bool operator()(const NodePair& pair) const {
    return (!fans_.empty() && are_fans_apart(pair)) || (!oriented_.empty() && are_boxes_apart(pair));
  }

 private:
  /// Triangles around a hub. From there each is seen as an arc on the unit sphere; two with disjoint arcs have no other
  /// point in common.
  struct Fan {
    std::uint32_t hub = no_index;  ///< none: something below is not at it
    Box arcs;
  };

  void make_fans();
  [[nodiscard]] Fan fan_of_block(std::uint32_t block, const std::vector<std::uint32_t>& triangles_at) const;
  [[nodiscard]] bool are_fans_apart(const NodePair& pair) const;
  [[nodiscard]] bool are_boxes_apart(const NodePair& pair) const;

  const ClosedModel::Data& model_;
  const Bvh::Data& tree_;
  std::vector<OrientedNode> oriented_;  ///< by node of the tree; empty where they are of no use
  std::vector<std::vector<Fan>> fans_;  ///< by level and node; empty where the model has no hub
  double margin_;                       ///< between oriented boxes that are apart, in the frame of the tree
};

}  // namespace meshbound
