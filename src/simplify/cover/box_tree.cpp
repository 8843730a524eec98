// SPDX-License-Identifier: MIT
#include "simplify/cover/box_tree.h"

#include <algorithm>

#include "numeric/numbers_below.h"

namespace meshbound {

namespace {

/// A leaf has at most so many boxes: fewer cost more steps down than they save comparisons.
constexpr std::size_t boxes_in_leaf = 4;

}  // namespace

BoxTree::BoxTree(std::vector<Eigen::AlignedBox3d> boxes) : order_(numbers_below(boxes.size())) {
  if (!boxes.empty()) build(boxes, 0, 0, boxes.size());
  boxes_.reserve(boxes.size());
  for (const std::uint32_t index : order_) boxes_.push_back(boxes[index]);
}

void BoxTree::build(const std::vector<Eigen::AlignedBox3d>& boxes, std::size_t node, std::size_t first,
                    std::size_t last) {
  if (node >= nodes_.size()) nodes_.resize(node + 1);
  Eigen::AlignedBox3d all;
  for (std::size_t i = first; i < last; ++i) all.extend(boxes[order_[i]]);
  nodes_[node] = all;
  if (last - first <= boxes_in_leaf) return;
  Eigen::Index axis = 0;
  all.sizes().maxCoeff(&axis);
  const std::size_t middle = first + (last - first) / 2;
  const auto at = [&](std::size_t i) { return order_.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(first), at(middle), at(last), [&](std::uint32_t a, std::uint32_t b) {
    const double p = boxes[a].min()[axis] + boxes[a].max()[axis], q = boxes[b].min()[axis] + boxes[b].max()[axis];
    return p < q || (p == q && a < b);
  });
  build(boxes, 2 * node + 1, first, middle);
  build(boxes, 2 * node + 2, middle, last);
}

void BoxTree::find(const Eigen::AlignedBox3d& box, std::vector<std::uint32_t>& found) const {
  if (!boxes_.empty()) search(0, 0, boxes_.size(), box, found);
}

void BoxTree::search(std::size_t node, std::size_t first, std::size_t last, const Eigen::AlignedBox3d& box,
                     std::vector<std::uint32_t>& found) const {
  if (!nodes_[node].intersects(box)) return;
  if (last - first <= boxes_in_leaf) {
    for (std::size_t i = first; i < last; ++i)
      if (boxes_[i].intersects(box)) found.push_back(order_[i]);
    return;
  }
  const std::size_t middle = first + (last - first) / 2;
  search(2 * node + 1, first, middle, box, found);
  search(2 * node + 2, middle, last, box, found);
}

}  // namespace meshbound
