// SPDX-License-Identifier: MIT
/// Cross-culling: paper, section 4, Algorithms 1 and 2, with a stack in place of the recursion.
///
/// The paper's volumes are swept spheres and Eq. 9 measures them from a point q of B. Here the tree's boxes serve, and
/// the triangle of B that q lies on: d(., t) is convex and t contains q, so the eight corners of a box give
///     h(BV, B) <= max over corners c of d(c, t) <= max over corners c of d(c, q) <= d(centre, q) + radius,
/// that is, never less tight than Eq. 9 for the box or for the ball around it.
#include <algorithm>
#include <array>

#include "distance/search/node_boxes.h"
#include "distance/search/steps.h"

namespace meshbound {
namespace {

struct NodeOfA {
  double bound_squared;  ///< of the distance of all its triangles to B
  std::uint32_t level;
  std::uint32_t index;

  bool operator<(const NodeOfA& other) const { return bound_squared < other.bound_squared; }
};

/// One run of the algorithm, by one thread.
class CrossCulling {
 public:
  explicit CrossCulling(OneSidedSearch& search) : search_(search), a_(search.a()), kernel_(search.begin_own_batch()) {}

  /// The triangles that wait for subdivision.
  std::vector<OpenTriangle> run() {
    const std::uint32_t root = a_.levels() - 1;
    stack_.push_back({node_bound_squared(root, 0), root, 0});
    DistanceStats& stats = search_.stats();
    double seconds_on_b = 0;
    std::uint64_t done = 0;
    while (!stack_.empty() && !search_.decided()) {
      const NodeOfA node = stack_.back();
      stack_.pop_back();
      const auto [begin, end] = slots_below(a_, node.level, node.index);
      if (node.bound_squared <= kernel_.accepted_squared() || search_.out_of_budget()) {
        kernel_.accept(node.bound_squared);
        stats.culled_by_node += end - begin;
        done += end - begin;
      } else if (node.level == 0) {
        const auto start = StopToken::Clock::now();
        cull_leaf_on_b(node.index);
        seconds_on_b += seconds_since(start);
        done += end - begin;
      } else {
        push_children(node);
      }
      search_.report_progress(0.3 * static_cast<double>(done) / a_.triangle_count());
    }
    search_.offer_upper_squared(kernel_.upper_squared());
    stats.phases.culling_on_b += seconds_on_b;
    stats.phases.culling_on_a -= seconds_on_b;  // the whole step is counted there
    return std::move(open_);
  }

 private:
  /// Eq. 8-9 for one node, from the triangle of B at `hint_`, which becomes the one that was used.
  double node_bound_squared(std::uint32_t level, std::uint32_t index) {
    const Box box = node_box(a_, level, index);
    const std::array<Vec3, 8> corners = corners_of(box, search_.map());
    hint_ = kernel_.nearest(search_.map()(0.5 * (box.lo + box.hi)), hint_, 0).slot;
    return kernel_.farthest_squared(corners, hint_);
  }

  /// Culling on B for the triangles of a leaf. Those whose upper bound is above the target wait for subdivision; their
  /// corners raise the lower bound.
  void cull_leaf_on_b(std::uint32_t block) {
    const OneSidedTask& task = search_.task();
    const std::uint32_t end = std::min(a_.triangle_count(), (block + 1) * block_width);
    for (std::uint32_t slot = block * block_width; slot < end && !search_.decided(); ++slot) {
      const TriangleCorners corners = search_.triangle(slot);
      const std::uint32_t paired = task.known_pairs != nullptr ? (*task.known_pairs)[slot] : no_slot;
      const std::array<std::uint32_t, 2> hints{hint_, paired == no_slot ? hint_ : paired};
      const double enough = search_.exhausted() ? std::numeric_limits<double>::infinity() : kernel_.accepted_squared();
      const GroupBounds bounds = kernel_.cull_on_b(corners, hints, enough);
      hint_ = bounds.upper.slot;
      if (task.found_pairs != nullptr) (*task.found_pairs)[hint_] = slot;
      if (bounds.upper.squared <= enough) {
        kernel_.accept(bounds.upper.squared);
        continue;
      }
      const std::size_t worst = bounds.worst_corner();
      search_.note_vertex(a_.corners[slot][worst], bounds.nearest[worst]);
      kernel_.offer(corners[worst], bounds.nearest[worst], slot);
      search_.offer_lower(kernel_.lower());
      open_.push_back({bounds.upper.squared, slot, hint_});
    }
  }

  /// The furthest child first: it raises the lower bound that culls the others.
  void push_children(const NodeOfA& node) {
    const std::size_t first = stack_.size();
    for (std::uint32_t k = 0; k < node_width; ++k) {
      const std::uint32_t child = node.index * node_width + k;
      const auto [from, to] = slots_below(a_, node.level - 1, child);
      if (from == to) break;
      stack_.push_back({node_bound_squared(node.level - 1, child), node.level - 1, child});
    }
    std::stable_sort(stack_.begin() + static_cast<std::ptrdiff_t>(first), stack_.end());
  }

  OneSidedSearch& search_;
  const Bvh::Data& a_;
  SearchKernel& kernel_;
  std::uint32_t hint_ = 0;  ///< slot of B
  std::vector<NodeOfA> stack_;
  std::vector<OpenTriangle> open_;
};

}  // namespace

std::vector<OpenTriangle> cross_cull(OneSidedSearch& search) {
  if (search.decided()) return {};
  return CrossCulling(search).run();
}

}  // namespace meshbound
