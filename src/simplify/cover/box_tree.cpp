// SPDX-License-Identifier: MIT
#include "simplify/cover/box_tree.h"

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

#include <algorithm>
#include <bit>
#include <limits>
#include <utility>

#include "numeric/numbers_below.h"

namespace meshbound {

BoxTree::Node::Node() {
  std::fill_n(lo[0], 3 * width, std::numeric_limits<double>::infinity());
  std::fill_n(hi[0], 3 * width, -std::numeric_limits<double>::infinity());
}

void BoxTree::Node::set(std::size_t lane, const Eigen::AlignedBox3d& box) {
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    lo[axis][lane] = box.min()[axis];
    hi[axis][lane] = box.max()[axis];
  }
}

/// By hand where processors have SSE2, which all of 64 bits have: compilers compare lane by lane otherwise.
unsigned BoxTree::Node::meeting(const Eigen::AlignedBox3d& box) const {
  unsigned bits = 0;
#if defined(__SSE2__)
  for (std::size_t lane = 0; lane < width; lane += 2) {
    __m128d meets = _mm_castsi128_pd(_mm_set1_epi32(-1));
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const __m128d below = _mm_cmple_pd(_mm_loadu_pd(&lo[axis][lane]), _mm_set1_pd(box.max()[axis])),
                    above = _mm_cmpge_pd(_mm_loadu_pd(&hi[axis][lane]), _mm_set1_pd(box.min()[axis]));
      meets = _mm_and_pd(meets, _mm_and_pd(below, above));
    }
    bits |= static_cast<unsigned>(_mm_movemask_pd(meets)) << lane;
  }
#else
  for (std::size_t lane = 0; lane < width; ++lane) {
    bool meets = true;
    for (Eigen::Index axis = 0; axis < 3; ++axis)
      meets = meets && lo[axis][lane] <= box.max()[axis] && hi[axis][lane] >= box.min()[axis];
    bits |= (meets ? 1U : 0U) << lane;
  }
#endif
  return bits;
}

BoxTree::BoxTree(const std::vector<Eigen::AlignedBox3d>& boxes) : order_(numbers_below(boxes.size())) {
  sort(boxes, 0, boxes.size());
  std::vector<Eigen::AlignedBox3d> below;
  for (const std::uint32_t index : order_) below.push_back(boxes[index]);
  while (levels_.empty() || levels_.back().size() > 1) {
    std::vector<Node>& nodes = levels_.emplace_back((below.size() + width - 1) / width);
    std::vector<Eigen::AlignedBox3d> around(nodes.size());
    for (std::size_t i = 0; i < below.size(); ++i) {
      nodes[i / width].set(i % width, below[i]);
      around[i / width].extend(below[i]);
    }
    below = std::move(around);
  }
}

/// Halves a range where the nodes of a level end: the subtrees on both sides hold boxes near one another.
void BoxTree::sort(const std::vector<Eigen::AlignedBox3d>& boxes, std::size_t first, std::size_t last) {
  if (last - first <= width) return;
  std::size_t step = width;
  while (step * width < last - first) step *= width;
  const std::size_t steps = (last - first + step - 1) / step, middle = first + steps / 2 * step;
  Eigen::AlignedBox3d all;
  for (std::size_t i = first; i < last; ++i) all.extend(boxes[order_[i]]);
  Eigen::Index axis = 0;
  all.sizes().maxCoeff(&axis);
  const auto at = [&](std::size_t i) { return order_.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(first), at(middle), at(last), [&](std::uint32_t a, std::uint32_t b) {
    const double p = boxes[a].min()[axis] + boxes[a].max()[axis], q = boxes[b].min()[axis] + boxes[b].max()[axis];
    return p < q || (p == q && a < b);
  });
  sort(boxes, first, middle);
  sort(boxes, middle, last);
}

void BoxTree::find(const Eigen::AlignedBox3d& box, std::vector<std::uint32_t>& found) const {
  if (!order_.empty()) search(levels_.size() - 1, 0, box, found);
}

void BoxTree::search(std::size_t level, std::size_t index, const Eigen::AlignedBox3d& box,
                     std::vector<std::uint32_t>& found) const {
  for (unsigned lanes = levels_[level][index].meeting(box); lanes != 0; lanes &= lanes - 1) {
    const std::size_t child = width * index + static_cast<std::size_t>(std::countr_zero(lanes));
    if (level > 0)
      search(level - 1, child, box, found);
    else
      found.push_back(order_[child]);
  }
}

}  // namespace meshbound
