// SPDX-License-Identifier: MIT
/// Culling on A by whole nodes: paper, Algorithm 1, with Eq. 8-9 taken for boxes.
#include <algorithm>
#include <array>
#include <cmath>
#include <queue>

#include "distance/search/node_boxes.h"
#include "distance/search/search_memory.h"
#include "distance/search/steps.h"
#include "numeric/no_index.h"
#include "numeric/rounding.h"
#include "numeric/tasks.h"

namespace meshbound {
namespace {

constexpr std::uint32_t sampled_blocks = 64;

/// Radius of blocks, in units of the target, from which a sweep over all triangles costs less than the queries that
/// cull nodes: measured on models that approach each other (section 7.1 of the paper).
constexpr double max_block_radius = 0.2;

/// Nodes that are opened at a time, the worst first. What one of them finds may spare opening the next: with 8 there
/// are up to a third more queries, with 4 at most an eighth.
constexpr std::size_t opened_at_once = 4;

/// A question costs at most a query, a few microseconds: a task of two costs more than handing it to a thread.
constexpr std::size_t questions_per_task = 2;

struct QueuedNode {
  double bound_squared;  ///< of the distance of all its triangles to B
  std::uint32_t level;
  std::uint32_t index;
  std::uint32_t slot;        ///< the triangle of B that gives the bound
  bool is_of_front = false;  ///< the bound is one of an earlier search, and is to be found anew before it is opened

  bool operator<(const QueuedNode& other) const {
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
    const std::array<Vec3, 8> corners = corners_of(box, map_);
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
  const Bvh::Data& a_;
  const Mapping& map_;
  double accepted_squared_;
  double scale_ = 1;
};

/// What is asked of B: how far at most a node of A is, or which triangle is nearest to a vertex of it.
struct Question {
  std::uint32_t level, index;       ///< of the node
  std::uint32_t vertex = no_index;  ///< of A; `no_index`: the node is meant
  std::uint32_t slot;               ///< of B: a hint, then the triangle that gives the answer
  double squared = 0;               ///< the answer

  [[nodiscard]] bool is_of_node() const { return vertex == no_index; }
};

/// One run of the algorithm.
class NodeCulling {
 public:
  NodeCulling(OneSidedSearch& search, const Remaining& remaining, SearchKernel& kernel)
      : search_(search), a_(search.a()), remaining_(remaining), kernel_(kernel) {
    SearchMemory* const memory = search.task().memory;
    if (memory != nullptr && memory->rigid && remaining.is_whole()) front_ = &memory->front;
  }

  /// The slots that are left, ascending.
  std::vector<std::uint32_t> run() {
    if (front_ != nullptr && is_coherent(*front_, search_))
      begin_at_front();
    else
      queue_.push({std::numeric_limits<double>::infinity(), a_.levels() - 1, 0, 0});
    while (!queue_.empty() && !search_.decided() && !search_.out_of_budget()) {
      open_worst();
      answer();
      take_answers();
    }
    search_.offer_upper_squared(kernel_.upper_squared());
    for (; !queue_.empty(); queue_.pop()) {
      keep_slots_below(queue_.top().level, queue_.top().index);
      add_to_front(queue_.top());
    }
    std::sort(left_.begin(), left_.end());
    if (front_ != nullptr) *front_ = {std::move(new_front_), search_.map(), search_.goal().slack, true};
    return std::move(left_);
  }

  /// Triangles in nodes that were near enough by the front alone.
  [[nodiscard]] std::uint64_t near_by_front() const { return near_by_front_; }

 private:
  void begin_at_front() {
    const double drift = drift_since(*front_, search_), accepted = std::sqrt(kernel_.accepted_squared());
    double largest = 0;
    for (const NodeFront::Node& node : front_->nodes) {
      const double upper = next_up(node.upper + drift);
      if (upper > accepted) {
        queue_.push({upper * upper, node.level, node.index, node.slot, true});
        continue;
      }
      const auto [begin, end] = slots_below(a_, node.level, node.index);
      near_by_front_ += end - begin;
      largest = std::max(largest, upper);
      new_front_.push_back({upper, node.level, node.index, node.slot});
    }
    search_.offer_known_upper(search_.b().frame.length_up(largest));
  }

  void add_to_front(const QueuedNode& node) {
    if (front_ == nullptr) return;
    new_front_.push_back({search_.goal().proven_upper(node.bound_squared, 0), node.level, node.index, node.slot});
  }

  /// Opens the worst nodes that are not near enough.
  void open_worst() {
    questions_.clear();
    for (std::size_t opened = 0; opened < opened_at_once && !queue_.empty(); queue_.pop()) {
      const QueuedNode& node = queue_.top();
      if (node.bound_squared <= kernel_.accepted_squared()) {
        kernel_.accept(node.bound_squared);
        record(node);
        add_to_front(node);
        continue;
      }
      open(node);
      ++opened;
    }
  }

  /// Asks for the bounds of the children of a node, or of itself where its bound is an old one. A leaf is too far for
  /// its size: its vertices may raise the lower bound.
  void open(const QueuedNode& node) {
    if (node.is_of_front) {
      questions_.push_back({.level = node.level, .index = node.index, .slot = node.slot});
      return;
    }
    if (node.level == 0) {
      add_to_front(node);
      keep_slots_below(0, node.index);
      for (const std::uint32_t v : a_.corners[node.index * block_width])
        questions_.push_back({.level = 0, .index = node.index, .vertex = v, .slot = node.slot});
      return;
    }
    for (std::uint32_t child = node.index * node_width; child < (node.index + 1) * node_width; ++child) {
      const auto [begin, end] = slots_below(a_, node.level - 1, child);
      if (begin == end) break;
      if (remaining_.holds_any(begin, end))
        questions_.push_back({.level = node.level - 1, .index = child, .slot = node.slot});
    }
  }

  /// Answers all questions. No answer depends on another one, nor on the thread that finds it.
  void answer() {
    const double accepted_squared = kernel_.accepted_squared();
    const NodeTest test(a_, search_.map(), accepted_squared);
    for_each_range(questions_.size(), questions_per_task, [&](std::size_t begin, std::size_t end) {
      SearchKernel& kernel = search_.own_kernel();
      for (std::size_t i = begin; i < end; ++i) {
        Question& question = questions_[i];
        if (question.is_of_node()) {
          question.squared = test.bound_squared(kernel, question.level, question.index, question.slot);
        } else {
          const Nearest nearest = kernel.nearest(search_.vertex(question.vertex), question.slot, accepted_squared);
          question.squared = nearest.squared;
          question.slot = nearest.slot;
        }
      }
    });
  }

  void take_answers() {
    for (const Question& question : questions_) {
      if (question.is_of_node()) {
        queue_.push({question.squared, question.level, question.index, question.slot});
      } else if (question.squared > kernel_.accepted_squared()) {
        const double upper = kernel_.upper_squared();
        search_.offer_vertex(question.vertex, {question.squared, question.slot});
        kernel_.begin(search_.lower());
        kernel_.accept(upper);
      }
    }
  }

  void record(const QueuedNode& node) {
    if (!search_.recorder().is_on()) return;
    const auto [begin, end] = slots_below(a_, node.level, node.index);
    for (std::uint32_t slot = begin; slot < end; ++slot)
      if (remaining_.holds(slot)) search_.recorder().triangle(slot, node.bound_squared, node.slot);
  }

  void keep_slots_below(std::uint32_t level, std::uint32_t index) {
    const auto [begin, end] = slots_below(a_, level, index);
    for (std::uint32_t slot = begin; slot < end; ++slot)
      if (remaining_.holds(slot)) left_.push_back(slot);
  }

  OneSidedSearch& search_;
  const Bvh::Data& a_;
  const Remaining& remaining_;
  SearchKernel& kernel_;  ///< of the thread that heads the team
  std::priority_queue<QueuedNode> queue_;
  std::vector<Question> questions_;
  std::vector<std::uint32_t> left_;
  NodeFront* front_ = nullptr;  ///< of the search before, replaced in the end; null: none is kept
  std::vector<NodeFront::Node> new_front_;
  std::uint64_t near_by_front_ = 0;
};

/// The mean radius of a few leaves of A, in B's frame.
double sampled_block_radius(const OneSidedSearch& search) {
  const Bvh::Data& a = search.a();
  const auto n = a.block_count();
  const std::uint32_t samples = std::min(n, sampled_blocks);
  double sum = 0;
  for (std::uint32_t i = 0; i < samples; ++i)
    sum += ball_around(node_box(a, 0, static_cast<std::uint32_t>(std::uint64_t{i} * n / samples))).radius;
  return length(search.map().rows[0]) * sum / samples;
}

/// Whether nothing has moved so far since the last search that A could now be beyond the target.
bool is_near_as_before(OneSidedSearch& search, double target) {
  const SearchMemory* const memory = search.task().memory;
  if (memory == nullptr || !memory->rigid || !is_within(memory->front, search, target)) return false;
  search.offer_known_upper(search.b().frame.length_up(target));
  search.stats().proven_before += search.stats().triangles - search.stats().matched;
  return true;
}

}  // namespace

Remaining cull_nodes(OneSidedSearch& search, Remaining remaining) {
  DistanceStats& stats = search.stats();
  if (search.decided() || stats.matched == stats.triangles) return remaining;
  SearchKernel& kernel = search.begin_own_batch();
  if (is_near_as_before(search, std::sqrt(kernel.accepted_squared()))) return {search.a().triangle_count(), {}};
  if (sampled_block_radius(search) > max_block_radius * std::sqrt(kernel.accepted_squared())) return remaining;
  NodeCulling culling(search, remaining, kernel);
  std::vector<std::uint32_t> left = culling.run();
  stats.proven_before += culling.near_by_front();
  stats.culled_by_node = stats.triangles - stats.matched - stats.proven_before - left.size();
  return {search.a().triangle_count(), std::move(left)};
}

}  // namespace meshbound
