// SPDX-License-Identifier: MIT
#include "simplify/cover/box_tree.h"

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <span>
#include <utility>

namespace meshbound {

BoxTree::Node::Node() {
  std::fill_n(lo[0], 3 * width, std::numeric_limits<float>::quiet_NaN());
  std::fill_n(hi[0], 3 * width, std::numeric_limits<float>::quiet_NaN());
}

void BoxTree::Node::set(std::size_t lane, const Box& box) {
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    lo[axis][lane] = box.lo[axis];
    hi[axis][lane] = box.hi[axis];
  }
}

/// By hand where processors have SSE2, which all of 64 bits have: compilers compare lane by lane otherwise.
#if defined(__SSE2__)
struct BoxTree::Wanted {
  explicit Wanted(const Box& box)
      : lo{_mm_set1_ps(box.lo[0]), _mm_set1_ps(box.lo[1]), _mm_set1_ps(box.lo[2])},
        hi{_mm_set1_ps(box.hi[0]), _mm_set1_ps(box.hi[1]), _mm_set1_ps(box.hi[2])} {}
  __m128 lo[3], hi[3];
};

unsigned BoxTree::Node::meeting(const Wanted& box) const {
  const auto meets_from = [&](std::size_t lane) {
    const auto meets_on = [&](std::size_t axis) {
      return _mm_and_ps(_mm_cmple_ps(_mm_loadu_ps(&lo[axis][lane]), box.hi[axis]),
                        _mm_cmpge_ps(_mm_loadu_ps(&hi[axis][lane]), box.lo[axis]));
    };
    return static_cast<unsigned>(_mm_movemask_ps(_mm_and_ps(_mm_and_ps(meets_on(0), meets_on(1)), meets_on(2))));
  };
  return meets_from(0) | meets_from(4) << 4;
}
#else
struct BoxTree::Wanted : Box {};

unsigned BoxTree::Node::meeting(const Wanted& box) const {
  unsigned bits = 0;
  for (std::size_t lane = 0; lane < width; ++lane) {
    bool meets = true;
    for (Eigen::Index axis = 0; axis < 3; ++axis)
      meets = meets && lo[axis][lane] <= box.hi[axis] && hi[axis][lane] >= box.lo[axis];
    bits |= (meets ? 1U : 0U) << lane;
  }
  return bits;
}
#endif

namespace {

/// A box by its place: that it is rounded to floats may only make the tree worse.
struct Item {
  std::array<float, 3> middle;
  std::uint32_t index;
};

/// Halves a range where the nodes of a level of nodes of `width` boxes end: the subtrees on both sides hold boxes near
/// one another.
void sort_in_halves(std::span<Item> items, std::size_t width) {
  if (items.size() <= width) return;
  std::size_t step = width;
  while (step * width < items.size()) step *= width;
  const std::size_t steps = (items.size() + step - 1) / step, middle = steps / 2 * step;
  std::array<float, 3> lo = items[0].middle, hi = lo;
  for (const Item& item : items)
    for (std::size_t k = 0; k < 3; ++k)
      lo[k] = std::min(lo[k], item.middle[k]), hi[k] = std::max(hi[k], item.middle[k]);
  std::size_t axis = 0;
  for (const std::size_t k : {1, 2})
    if (hi[k] - lo[k] > hi[axis] - lo[axis]) axis = k;
  std::nth_element(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(middle), items.end(),
                   [axis](const Item& a, const Item& b) {
                     const float p = a.middle[axis], q = b.middle[axis];
                     return p < q || (p == q && a.index < b.index);
                   });
  sort_in_halves(items.first(middle), width);
  sort_in_halves(items.subspan(middle), width);
}

std::vector<std::uint32_t> order_of(const std::vector<Eigen::AlignedBox3d>& boxes, std::size_t width) {
  std::vector<Item> items;
  items.reserve(boxes.size());
  for (std::uint32_t i = 0; i < boxes.size(); ++i) {
    const Eigen::Vector3f middle =
        boxes[i].isEmpty() ? Eigen::Vector3f::Zero() : boxes[i].center().cast<float>().eval();
    items.push_back({{middle.x(), middle.y(), middle.z()}, i});
  }
  sort_in_halves(items, width);
  std::vector<std::uint32_t> order;
  order.reserve(items.size());
  for (const Item& item : items) order.push_back(item.index);
  return order;
}

}  // namespace

BoxTree::Box BoxTree::rounded(const Eigen::AlignedBox3d& box) const {
  return {(box.min() - origin_).cast<float>(), (box.max() - origin_).cast<float>()};
}

BoxTree::BoxTree(const std::vector<Eigen::AlignedBox3d>& boxes) : order_(order_of(boxes, width)) {
  if (order_.empty()) return;
  const Eigen::Vector3d middle = boxes[order_[order_.size() / 2]].center();
  if (middle.allFinite()) origin_ = middle;
  const auto add_level = [&](std::size_t count, const auto& box_at) {
    std::vector<Node>& nodes = levels_.emplace_back((count + width - 1) / width);
    std::vector<Eigen::AlignedBox3d> around(nodes.size());
    for (std::size_t i = 0; i < count; ++i) {
      const Eigen::AlignedBox3d& box = box_at(i);
      if (box.isEmpty()) continue;
      nodes[i / width].set(i % width, rounded(box));
      around[i / width].extend(box);
    }
    return around;
  };
  std::vector<Eigen::AlignedBox3d> around =
      add_level(order_.size(), [&](std::size_t i) -> const Eigen::AlignedBox3d& { return boxes[order_[i]]; });
  while (levels_.back().size() > 1)
    around = add_level(around.size(), [&](std::size_t i) -> const Eigen::AlignedBox3d& { return around[i]; });
}

template <class Visit>
void BoxTree::visit_meeting(const Eigen::AlignedBox3d& box, const Visit& visit) const {
  if (order_.empty()) return;
  const Wanted wanted{rounded(box)};
  std::array<unsigned, max_levels> open;           // by level above the lowest: lanes of a node that are left
  std::array<std::size_t, max_levels> first_lane;  // and the number of its first lane
  const std::size_t top = levels_.size() - 1;
  for (std::size_t level = top, node = 0;;) {
    const unsigned meeting = levels_[level][node].meeting(wanted);
    if (level == 0) {
      if (meeting != 0 && !visit(node, meeting)) return;
      ++level;
    } else {
      open[level] = meeting;
      first_lane[level] = width * node;
    }
    while (level <= top && open[level] == 0) ++level;
    if (level > top) return;
    node = first_lane[level] + static_cast<std::size_t>(std::countr_zero(open[level]));
    open[level] &= open[level] - 1;
    --level;
  }
}

void BoxTree::find(const Eigen::AlignedBox3d& box, std::vector<std::uint32_t>& found) const {
  visit_meeting(box, [&](std::size_t node, unsigned meeting) {
    for (unsigned lanes = meeting; lanes != 0; lanes &= lanes - 1)
      found.push_back(order_[width * node + static_cast<std::size_t>(std::countr_zero(lanes))]);
    return true;
  });
}

bool BoxTree::meets(const Eigen::AlignedBox3d& box) const {
  bool is_met = false;
  visit_meeting(box, [&](std::size_t, unsigned) {
    is_met = true;
    return false;
  });
  return is_met;
}

}  // namespace meshbound
