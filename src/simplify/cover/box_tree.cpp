// SPDX-License-Identifier: MIT
#include "simplify/cover/box_tree.h"

#include <algorithm>

#include "numeric/numbers_below.h"

namespace meshbound {

BoxTree::BoxTree(std::vector<Eigen::AlignedBox3d> boxes)
    : boxes_(std::move(boxes)), order_(numbers_below(boxes_.size())) {
  if (!boxes_.empty()) build(0, 0, boxes_.size());
}

void BoxTree::build(std::size_t node, std::size_t first, std::size_t last) {
  if (node >= nodes_.size()) nodes_.resize(node + 1);
  Eigen::AlignedBox3d all;
  for (std::size_t i = first; i < last; ++i) all.extend(boxes_[order_[i]]);
  nodes_[node] = all;
  if (last - first < 2) return;
  Eigen::Index axis = 0;
  all.sizes().maxCoeff(&axis);
  const std::size_t middle = first + (last - first) / 2;
  const auto at = [&](std::size_t i) { return order_.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(first), at(middle), at(last), [&](std::uint32_t a, std::uint32_t b) {
    const double p = boxes_[a].min()[axis] + boxes_[a].max()[axis], q = boxes_[b].min()[axis] + boxes_[b].max()[axis];
    return p < q || (p == q && a < b);
  });
  build(2 * node + 1, first, middle);
  build(2 * node + 2, middle, last);
}

void BoxTree::find(const Eigen::AlignedBox3d& box, std::vector<std::uint32_t>& found) const {
  if (!boxes_.empty()) search(0, 0, boxes_.size(), box, found);
}

void BoxTree::search(std::size_t node, std::size_t first, std::size_t last, const Eigen::AlignedBox3d& box,
                     std::vector<std::uint32_t>& found) const {
  if (!nodes_[node].intersects(box)) return;
  if (last - first == 1) {
    found.push_back(order_[first]);
    return;
  }
  const std::size_t middle = first + (last - first) / 2;
  search(2 * node + 1, first, middle, box, found);
  search(2 * node + 2, middle, last, box, found);
}

}  // namespace meshbound
