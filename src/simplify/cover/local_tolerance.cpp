// SPDX-License-Identifier: MIT
#include "simplify/cover/local_tolerance.h"

#include <algorithm>
#include <limits>

#include "numeric/numbers_below.h"

namespace meshbound {

LocalTolerance::LocalTolerance(const std::vector<Eigen::AlignedBox3d>& boxes, std::span<const double> tolerances)
    : count_(boxes.size()) {
  Input input{boxes, tolerances, numbers_below(count_)};
  if (count_ > 0) build(0, 0, count_, input);
}

void LocalTolerance::build(std::size_t node, std::size_t first, std::size_t last, Input& input) {
  const auto& boxes = input.boxes;
  auto& order = input.order;
  if (node >= nodes_.size()) nodes_.resize(node + 1);
  Node here;
  here.smallest = std::numeric_limits<double>::infinity();
  for (std::size_t i = first; i < last; ++i) {
    here.box.extend(boxes[order[i]]);
    here.smallest = std::min(here.smallest, input.tolerances[order[i]]);
  }
  nodes_[node] = here;
  if (last - first < 2) return;
  Eigen::Index axis = 0;
  here.box.sizes().maxCoeff(&axis);
  const std::size_t middle = first + (last - first) / 2;
  const auto at = [&](std::size_t i) { return order.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(first), at(middle), at(last), [&](std::uint32_t a, std::uint32_t b) {
    return boxes[a].min()[axis] + boxes[a].max()[axis] < boxes[b].min()[axis] + boxes[b].max()[axis];
  });
  build(2 * node + 1, first, middle, input);
  build(2 * node + 2, middle, last, input);
}

double LocalTolerance::sufficient_around(const Eigen::AlignedBox3d& box, double max) const {
  double enough = smallest_near(box, max);
  if (enough >= max) return max;
  // smallest_near falls as the reach grows: `enough` suffices, and what suffices ends somewhere below `max`.
  double too_much = max;
  for (int step = 0; step < 30; ++step) {
    const double middle = enough + (too_much - enough) / 2;
    (smallest_near(box, middle) >= middle ? enough : too_much) = middle;
  }
  return enough;
}

double LocalTolerance::smallest_near(const Eigen::AlignedBox3d& box, double reach) const {
  double smallest = std::numeric_limits<double>::infinity();
  // More than the rounding of the sums.
  const double slack = 0x1p-50 * (reach + box.min().cwiseAbs().maxCoeff() + box.max().cwiseAbs().maxCoeff());
  const Eigen::AlignedBox3d grown(box.min().array() - (reach + slack), box.max().array() + (reach + slack));
  if (count_ > 0) search(0, 0, count_, grown, smallest);
  return smallest;
}

void LocalTolerance::search(std::size_t node, std::size_t first, std::size_t last, const Eigen::AlignedBox3d& box,
                            double& smallest) const {
  const Node& here = nodes_[node];
  if (!(here.smallest < smallest) || !here.box.intersects(box)) return;
  if (last - first == 1) {
    smallest = here.smallest;
    return;
  }
  const std::size_t middle = first + (last - first) / 2;
  search(2 * node + 1, first, middle, box, smallest);
  search(2 * node + 2, middle, last, box, smallest);
}

}  // namespace meshbound
