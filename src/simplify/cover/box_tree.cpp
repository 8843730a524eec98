// SPDX-License-Identifier: MIT
#include "simplify/cover/box_tree.h"

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

namespace meshbound {

template <int axes>
BoxTreeOf<axes>::Node::Node() {
  std::fill_n(lo[0], axes * width, std::numeric_limits<float>::quiet_NaN());
  std::fill_n(hi[0], axes * width, std::numeric_limits<float>::quiet_NaN());
}

template <int axes>
void BoxTreeOf<axes>::Node::set(std::size_t lane, const Box& box) {
  for (Eigen::Index axis = 0; axis < axes; ++axis) {
    lo[axis][lane] = box.lo[axis];
    hi[axis][lane] = box.hi[axis];
  }
}

/// By hand where processors have SSE2, which all of 64 bits have: compilers compare lane by lane otherwise.
#if defined(__SSE2__)
template <int axes>
struct BoxTreeOf<axes>::Wanted {
  explicit Wanted(const Box& box) {
    for (int axis = 0; axis < axes; ++axis) lo[axis] = _mm_set1_ps(box.lo[axis]), hi[axis] = _mm_set1_ps(box.hi[axis]);
  }
  __m128 lo[axes], hi[axes];
};

template <int axes>
unsigned BoxTreeOf<axes>::Node::meeting(const Wanted& box) const {
  const auto meets_from = [&](std::size_t lane) {
    const auto meets_on = [&](std::size_t axis) {
      return _mm_and_ps(_mm_cmple_ps(_mm_loadu_ps(&lo[axis][lane]), box.hi[axis]),
                        _mm_cmpge_ps(_mm_loadu_ps(&hi[axis][lane]), box.lo[axis]));
    };
    __m128 meets = meets_on(0);
    for (std::size_t axis = 1; axis < axes; ++axis) meets = _mm_and_ps(meets, meets_on(axis));
    return static_cast<unsigned>(_mm_movemask_ps(meets));
  };
  return meets_from(0) | meets_from(4) << 4;
}
#else
template <int axes>
struct BoxTreeOf<axes>::Wanted : Box {};

template <int axes>
unsigned BoxTreeOf<axes>::Node::meeting(const Wanted& box) const {
  unsigned bits = 0;
  for (std::size_t lane = 0; lane < width; ++lane) {
    bool meets = true;
    for (Eigen::Index axis = 0; axis < axes; ++axis)
      meets = meets && lo[axis][lane] <= box.hi[axis] && hi[axis][lane] >= box.lo[axis];
    bits |= (meets ? 1U : 0U) << lane;
  }
  return bits;
}
#endif

/// Bounds are lowered by the rounding of the coordinates of the point and of the boxes: those of a box are at most
/// those of the point and the difference together.
template <int axes>
typename BoxTreeOf<axes>::NearLanes BoxTreeOf<axes>::Node::near(const Corner& point, double squared_reach) const {
  constexpr float rounding = 0x1p-20F;
  std::array<float, width> squared{};
  for (Eigen::Index axis = 0; axis < axes; ++axis) {
    const float at = point[axis], error = rounding * std::abs(at);
    for (std::size_t lane = 0; lane < width; ++lane) {
      const float beyond = (1 - rounding) * std::max(lo[axis][lane] - at, at - hi[axis][lane]) - error;
      squared[lane] += beyond > 0 ? beyond * beyond : 0;  // 0 where it is not a number
    }
  }
  NearLanes near;
  for (std::size_t lane = 0; lane < width; ++lane) {
    const NearLane found{std::min(squared[lane], std::numeric_limits<float>::max()), lane};
    if (std::isnan(lo[0][lane]) || !(found.squared <= squared_reach)) continue;
    std::size_t i = near.count++;
    for (; i > 0 && near.lanes[i - 1].squared > found.squared; --i) near.lanes[i] = near.lanes[i - 1];
    near.lanes[i] = found;
  }
  return near;
}

namespace {

/// A box by its place: that it is rounded to floats may only make the tree worse.
template <int axes>
struct Item {
  std::array<float, axes> middle;
  std::uint32_t index;
};

/// Halves a range where the nodes of a level of nodes of `width` boxes end: the subtrees on both sides hold boxes near
/// one another.
template <int axes>
void sort_in_halves(std::span<Item<axes>> items, std::size_t width) {
  if (items.size() <= width) return;
  std::size_t step = width;
  while (step * width < items.size()) step *= width;
  const std::size_t steps = (items.size() + step - 1) / step, middle = steps / 2 * step;
  std::array<float, axes> lo = items[0].middle, hi = lo;
  for (const Item<axes>& item : items)
    for (std::size_t k = 0; k < axes; ++k)
      lo[k] = std::min(lo[k], item.middle[k]), hi[k] = std::max(hi[k], item.middle[k]);
  std::size_t axis = 0;
  for (std::size_t k = 1; k < axes; ++k)
    if (hi[k] - lo[k] > hi[axis] - lo[axis]) axis = k;
  std::nth_element(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(middle), items.end(),
                   [axis](const Item<axes>& a, const Item<axes>& b) {
                     const float p = a.middle[axis], q = b.middle[axis];
                     return p < q || (p == q && a.index < b.index);
                   });
  sort_in_halves<axes>(items.first(middle), width);
  sort_in_halves<axes>(items.subspan(middle), width);
}

template <int axes>
std::vector<std::uint32_t> order_of(const std::vector<Eigen::AlignedBox<double, axes>>& boxes, std::size_t width) {
  std::vector<Item<axes>> items;
  items.reserve(boxes.size());
  for (std::uint32_t i = 0; i < boxes.size(); ++i) {
    Item<axes>& item = items.emplace_back();
    item.index = i;
    if (boxes[i].isEmpty()) continue;
    const Eigen::Matrix<double, axes, 1> middle = boxes[i].center();
    for (Eigen::Index k = 0; k < axes; ++k) item.middle[static_cast<std::size_t>(k)] = static_cast<float>(middle[k]);
  }
  sort_in_halves<axes>(items, width);
  std::vector<std::uint32_t> order;
  order.reserve(items.size());
  for (const Item<axes>& item : items) order.push_back(item.index);
  return order;
}

}  // namespace

template <int axes>
typename BoxTreeOf<axes>::Box BoxTreeOf<axes>::rounded(const AlignedBox& box) const {
  return {(box.min() - origin_).template cast<float>(), (box.max() - origin_).template cast<float>()};
}

template <int axes>
BoxTreeOf<axes>::BoxTreeOf(const std::vector<AlignedBox>& boxes) : order_(order_of<axes>(boxes, width)) {
  if (order_.empty()) return;
  const Eigen::Matrix<double, axes, 1> middle = boxes[order_[order_.size() / 2]].center();
  if (middle.allFinite()) origin_ = middle;
  const auto add_level = [&](std::size_t count, const auto& box_at) {
    std::vector<Node>& nodes = levels_.emplace_back((count + width - 1) / width);
    std::vector<AlignedBox> around(nodes.size());
    for (std::size_t i = 0; i < count; ++i) {
      const AlignedBox& box = box_at(i);
      if (box.isEmpty()) continue;
      nodes[i / width].set(i % width, rounded(box));
      around[i / width].extend(box);
    }
    return around;
  };
  std::vector<AlignedBox> around =
      add_level(order_.size(), [&](std::size_t i) -> const AlignedBox& { return boxes[order_[i]]; });
  while (levels_.back().size() > 1)
    around = add_level(around.size(), [&](std::size_t i) -> const AlignedBox& { return around[i]; });
}

template <int axes>
BoxTreeOf<axes>::Search::Search(const BoxTreeOf& tree, const AlignedBox& box) : tree_(tree), box_(tree.rounded(box)) {
  if (tree.order_.empty()) return;
  const std::size_t top = tree.levels_.size() - 1;
  open_[top] = tree.levels_[top][0].meeting(Wanted{box_});
  first_lane_[top] = 0;
}

/// Goes to the next node of the lowest level with boxes that meet the box. False if there is none.
template <int axes>
bool BoxTreeOf<axes>::Search::next_node(const Wanted& wanted) {
  for (std::size_t level = 1; level < tree_.levels_.size();) {
    if (open_[level] == 0) {
      ++level;
      continue;
    }
    const std::size_t node = first_lane_[level] + static_cast<std::size_t>(std::countr_zero(open_[level]));
    open_[level] &= open_[level] - 1;
    --level;
    open_[level] = tree_.levels_[level][node].meeting(wanted);
    first_lane_[level] = width * node;
    if (level == 0 && open_[0] != 0) return true;
    level = std::max<std::size_t>(level, 1);
  }
  return false;
}

template <int axes>
std::optional<std::uint32_t> BoxTreeOf<axes>::Search::next() {
  if (open_[0] == 0 && !next_node(Wanted{box_})) return std::nullopt;
  const auto lane = static_cast<std::size_t>(std::countr_zero(open_[0]));
  open_[0] &= open_[0] - 1;
  return tree_.order_[first_lane_[0] + lane];
}

template <int axes>
void BoxTreeOf<axes>::find(const AlignedBox& box, std::vector<std::uint32_t>& found) const {
  Search search(*this, box);
  const Wanted wanted{search.box_};
  for (unsigned& lanes = search.open_[0]; lanes != 0 || search.next_node(wanted);)
    for (; lanes != 0; lanes &= lanes - 1)
      found.push_back(order_[search.first_lane_[0] + static_cast<std::size_t>(std::countr_zero(lanes))]);
}

template <int axes>
bool BoxTreeOf<axes>::meets(const AlignedBox& box) const {
  return Search(*this, box).next().has_value();
}

template class BoxTreeOf<3>;
template class BoxTreeOf<6>;

}  // namespace meshbound
