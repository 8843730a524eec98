// SPDX-License-Identifier: MIT
/// Culling on A by whole nodes: paper, Algorithm 1, with Eq. 8-9 taken for boxes.
#include <algorithm>
#include <array>
#include <cmath>
#include <queue>

#include "bvh/build.h"
#include "distance/search/one_sided_search.h"
#include "numeric/tasks.h"

namespace meshbound {
namespace {

constexpr std::uint32_t sampled_blocks = 64;

/// Radius of blocks, in units of the target, from which a sweep over all triangles costs less than the queries that
/// cull nodes: measured on models that approach each other (section 7.1 of the paper).
constexpr double largest_block = 0.2;

/// Nodes that are opened at a time, the worst first. What one of them finds may spare opening the next: with 8 there
/// are up to a third more queries, with 4 at most an eighth.
constexpr std::size_t opened_at_once = 4;

/// Each is a query of a few microseconds, or far less.
constexpr std::size_t questions_per_task = 2;

struct NodeOfA {
  double bound_squared;  ///< of the distance of all its triangles to B
  std::uint32_t level;
  std::uint32_t index;
  std::uint32_t slot;  ///< the triangle of B that gives the bound

  bool operator<(const NodeOfA& other) const {
    if (bound_squared != other.bound_squared) return bound_squared < other.bound_squared;
    return level != other.level ? level < other.level : index > other.index;
  }
};

struct Ball {
  Vec3 centre;
  double radius;
};

Ball ball_around(const Box& box) { return {0.5 * (box.lo + box.hi), 0.5 * length(box.hi - box.lo)}; }

/// Nodes of A, tested against B.
class NodeTest {
 public:
  NodeTest(const Bvh::Data& a, const Mapping& map, double accepted_squared)
      : a_(a), map_(map), accepted_squared_(accepted_squared) {
    scale_ = length(map.rows[0]) * (1 + 0x1p-40);
  }

  /// Eq. 8 for a node, and the triangle that gives it, which replaces `slot`. First by the corners of its box and the
  /// triangle that bounds the node above: d(., t) is convex, so they bound the box, and where that is enough no query
  /// is spent. Then by the triangle nearest to the centre, and by the ball around the box. Infinite where the ball is
  /// larger than the target, which a query would hardly meet.
  double bound_squared(SearchKernel& kernel, std::uint32_t level, std::uint32_t index, std::uint32_t& slot) const {
    const Box box = node_box(a_, level, index);
    const std::array<Vec3, 8> corners = corners_of(box);
    const double by_hint = kernel.farthest_squared(corners, slot);
    if (by_hint <= accepted_squared_) return by_hint;
    const Ball ball = ball_around(box);
    const double reach = scale_ * ball.radius;
    if (reach * reach >= accepted_squared_) return std::numeric_limits<double>::infinity();
    const Nearest nearest = kernel.nearest(map_(ball.centre), slot, 0);
    slot = nearest.slot;
    const double by_ball = std::sqrt(nearest.squared) + reach;
    return std::min(by_ball * by_ball * (1 + 0x1p-40), kernel.farthest_squared(corners, slot));
  }

 private:
  [[nodiscard]] std::array<Vec3, 8> corners_of(const Box& box) const {
    std::array<Vec3, 8> corners;
    for (std::size_t i = 0; i < 8; ++i)
      corners[i] = map_(
          {(i & 1) != 0 ? box.hi.x : box.lo.x, (i & 2) != 0 ? box.hi.y : box.lo.y, (i & 4) != 0 ? box.hi.z : box.lo.z});
    return corners;
  }

  const Bvh::Data& a_;
  const Mapping& map_;
  double accepted_squared_;
  double scale_ = 1;
};

}  // namespace

double OneSidedSearch::sampled_block_radius() const {
  const auto n = a_.block_count();
  const std::uint32_t samples = std::min(n, sampled_blocks);
  double sum = 0;
  for (std::uint32_t i = 0; i < samples; ++i)
    sum += ball_around(node_box(a_, 0, static_cast<std::uint32_t>(std::uint64_t{i} * n / samples))).radius;
  return length(map_.rows[0]) * sum / samples;
}

void OneSidedSearch::cull_nodes() {
  if (decided() || stats_.matched == stats_.triangles) return;
  SearchKernel& kernel = *kernels_.front();
  kernel.begin(lower_);
  if (sampled_block_radius() > largest_block * std::sqrt(kernel.accepted_squared())) return;
  std::priority_queue<NodeOfA> queue;
  queue.push({std::numeric_limits<double>::infinity(), a_.levels() - 1, 0, 0});
  std::vector<NodeQuestion> questions;
  while (!queue.empty() && !decided() && !out_of_budget()) {
    questions.clear();
    for (std::size_t opened = 0; opened < opened_at_once && !queue.empty(); queue.pop()) {
      const NodeOfA node = queue.top();
      if (node.bound_squared <= kernel.accepted_squared()) {
        kernel.accept(node.bound_squared);
        remember_node(node.level, node.index, node.bound_squared, node.slot);
        continue;
      }
      open_node(node.level, node.index, node.slot, questions);
      ++opened;
    }
    answer(questions, kernel.accepted_squared());
    for (const NodeQuestion& question : questions) {
      if (question.vertex == NodeQuestion::no_vertex) {
        queue.push({question.squared, question.level, question.index, question.slot});
      } else if (question.squared > kernel.accepted_squared()) {
        const double upper = kernel.upper_squared();
        offer_vertex(question.vertex, {question.squared, question.slot});
        kernel.begin(lower_);
        kernel.accept(upper);
      }
    }
  }
  upper_squared_ = std::max(upper_squared_, kernel.upper_squared());
  for (; !queue.empty(); queue.pop()) keep_slots_below(queue.top().level, queue.top().index);
  std::sort(left_.begin(), left_.end());
  culled_ = true;
  stats_.culled_by_node = stats_.triangles - stats_.matched - stats_.proven_before - left_.size();
}

/// Asks for the bounds of the children of a node. A leaf is too far for its size: its vertices may raise the lower
/// bound.
void OneSidedSearch::open_node(std::uint32_t level, std::uint32_t index, std::uint32_t slot,
                               std::vector<NodeQuestion>& questions) {
  if (level == 0) {
    keep_slots_below(0, index);
    for (const std::uint32_t v : a_.corners[index * block_width])
      questions.push_back({.level = 0, .index = index, .vertex = v, .slot = slot});
    return;
  }
  for (std::uint32_t child = index * node_width; child < (index + 1) * node_width; ++child) {
    const auto [begin, end] = slots_below(a_, level - 1, child);
    if (begin == end) break;
    if (!alive_.empty() &&
        std::find(alive_.begin() + begin, alive_.begin() + end, std::uint8_t{1}) == alive_.begin() + end)
      continue;
    questions.push_back({.level = level - 1, .index = child, .slot = slot});
  }
}

/// Each by itself, whatever thread answers it.
void OneSidedSearch::answer(std::vector<NodeQuestion>& questions, double accepted_squared) {
  const NodeTest test(a_, map_, accepted_squared);
  for_each_range(questions.size(), questions_per_task, [&](std::size_t begin, std::size_t end) {
    SearchKernel& kernel = own_kernel();
    for (std::size_t i = begin; i < end; ++i) {
      NodeQuestion& question = questions[i];
      if (question.vertex == NodeQuestion::no_vertex) {
        question.squared = test.bound_squared(kernel, question.level, question.index, question.slot);
      } else {
        const Nearest nearest = kernel.nearest(vertex(question.vertex), question.slot, accepted_squared);
        question.squared = nearest.squared;
        question.slot = nearest.slot;
      }
    }
  });
}

void OneSidedSearch::remember_node(std::uint32_t level, std::uint32_t index, double squared, std::uint32_t face) {
  if (task_.memory == nullptr) return;
  const double bound = proven_model_length(squared, 0);
  const auto [begin, end] = slots_below(a_, level, index);
  for (std::uint32_t slot = begin; slot < end; ++slot)
    if (is_alive(slot)) task_.memory->improve(slot, bound, face);
}

void OneSidedSearch::keep_slots_below(std::uint32_t level, std::uint32_t index) {
  const auto [begin, end] = slots_below(a_, level, index);
  for (std::uint32_t slot = begin; slot < end; ++slot)
    if (is_alive(slot)) left_.push_back(slot);
}

}  // namespace meshbound
