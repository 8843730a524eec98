// SPDX-License-Identifier: MIT
/// Cross-culling: paper, section 4, Algorithms 1 and 2, with a stack in place of the recursion.
///
/// The paper's volumes are swept spheres and Eq. 9 measures them from a point q of B. Here the tree's boxes serve, and
/// the triangle of B that q lies on: d(., t) is convex and t contains q, so the eight corners of a box give
///     h(BV, B) <= max over corners c of d(c, t) <= max over corners c of d(c, q) <= d(centre, q) + radius,
/// that is, never less tight than Eq. 9 for the box or for the ball around it.
#include <algorithm>
#include <array>

#include "bvh/build.h"
#include "distance/search/one_sided_search.h"

namespace meshbound {
namespace {

using Clock = std::chrono::steady_clock;

struct NodeOfA {
  double bound_squared;  ///< of the distance of all its triangles to B
  std::uint32_t level;
  std::uint32_t index;

  bool operator<(const NodeOfA& other) const { return bound_squared < other.bound_squared; }
};

}  // namespace

/// Eq. 8-9 for one node; `hint` is a triangle of B to start from, and returns the one that was used.
double OneSidedSearch::node_bound_squared(SearchKernel& kernel, std::uint32_t level, std::uint32_t index,
                                          std::uint32_t& hint) const {
  const Box box = node_box(a_, level, index);
  std::array<Vec3, 8> corners;
  for (std::uint32_t i = 0; i < 8; ++i)
    corners[i] = map_({(i & 1) ? box.hi.x : box.lo.x, (i & 2) ? box.hi.y : box.lo.y, (i & 4) ? box.hi.z : box.lo.z});
  hint = kernel.nearest(map_(0.5 * (box.lo + box.hi)), hint, 0).slot;
  return kernel.farthest_squared(corners, hint);
}

/// Culling on B for the triangles of a leaf. Those whose upper bound is above the target wait for subdivision; their
/// corners raise the lower bound.
void OneSidedSearch::cull_leaf_on_b(SearchKernel& kernel, std::uint32_t block, std::uint32_t& hint) {
  const std::uint32_t end = std::min(a_.triangle_count(), (block + 1) * block_width);
  for (std::uint32_t slot = block * block_width; slot < end && !decided(); ++slot) {
    const Triangle& t = a_.corners[slot];
    const TriangleCorners corners{vertex(t[0]), vertex(t[1]), vertex(t[2])};
    const std::uint32_t paired = task_.known_pairs != nullptr ? (*task_.known_pairs)[slot] : no_slot;
    const std::array<std::uint32_t, 2> hints{hint, paired == no_slot ? hint : paired};
    const double enough = exhausted_ ? std::numeric_limits<double>::infinity() : kernel.accepted_squared();
    const GroupBounds bounds = kernel.cull_on_b(corners, hints, enough);
    hint = bounds.upper.slot;
    if (task_.found_pairs != nullptr) (*task_.found_pairs)[hint] = slot;
    if (bounds.upper.squared <= enough) {
      kernel.accept(bounds.upper.squared);
      continue;
    }
    const std::size_t worst = bounds.worst_corner();
    if (bounds.nearest[worst].squared > farthest_nearest_.squared) {
      farthest_nearest_ = bounds.nearest[worst];
      farthest_vertex_ = t[worst];
    }
    kernel.offer(corners[worst], bounds.nearest[worst], slot);
    if (kernel.lower().lower > lower_.lower) lower_ = own_lower_ = kernel.lower();
    open_.push_back({bounds.upper.squared, slot, hint});
  }
}

void OneSidedSearch::cross_cull() {
  if (decided()) return;
  SearchKernel& kernel = *kernels_.front();
  kernel.begin(lower_);
  std::uint32_t hint = 0;
  std::vector<NodeOfA> stack;
  const std::uint32_t root = a_.levels() - 1;
  stack.push_back({node_bound_squared(kernel, root, 0, hint), root, 0});
  Clock::duration on_b{};
  std::uint64_t settled = 0;
  while (!stack.empty() && !decided()) {
    const NodeOfA node = stack.back();
    stack.pop_back();
    const auto [begin, end] = slots_below(a_, node.level, node.index);
    if (node.bound_squared <= kernel.accepted_squared() || out_of_budget()) {
      kernel.accept(node.bound_squared);
      stats_.culled_by_node += end - begin;
      settled += end - begin;
    } else if (node.level == 0) {
      const auto start = Clock::now();
      cull_leaf_on_b(kernel, node.index, hint);
      on_b += Clock::now() - start;
      settled += end - begin;
    } else {
      const std::size_t first = stack.size();
      for (std::uint32_t k = 0; k < node_width; ++k) {
        const std::uint32_t child = node.index * node_width + k;
        const auto [from, to] = slots_below(a_, node.level - 1, child);
        if (from == to) break;
        stack.push_back({node_bound_squared(kernel, node.level - 1, child, hint), node.level - 1, child});
      }
      // The furthest child first: it raises the lower bound that culls the others.
      std::stable_sort(stack.begin() + static_cast<std::ptrdiff_t>(first), stack.end());
    }
    report_progress(0.3 * static_cast<double>(settled) / a_.triangle_count());
  }
  upper_squared_ = std::max(upper_squared_, kernel.upper_squared());
  const double seconds = std::chrono::duration<double>(on_b).count();
  stats_.phases.culling_on_b += seconds;
  stats_.phases.culling_on_a -= seconds;  // `run` counts the whole step there
}

}  // namespace meshbound
