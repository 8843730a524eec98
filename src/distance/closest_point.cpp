// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "bvh/bvh_data.h"
#include "distance/kernel/point_query.h"
#include "distance/kernel/search_kernel.h"
#include "distance/query_order.h"
#include "distance/shortcuts/point_like.h"
#include "geometry/eigen_vec3.h"
#include "geometry/magnitude.h"
#include "geometry/safe_length.h"
#include "meshbound/error.h"
#include "numeric/rounding.h"
#include "numeric/tasks.h"
#include "numeric/thread_count.h"

namespace meshbound {
namespace {

/// Queries that make one task: some half a millisecond of work.
constexpr std::size_t queries_per_task = 1024;

/// Queries between two looks at the clock: each may take a millisecond where tens of thousands of triangles are equally
/// near, as around a hub.
constexpr std::size_t queries_between_looks = 32;

/// The answer where the mesh is a point beside its distance: see `distance_to_point_like`.
ClosestPoint closest_of_point_like(const Bvh::Data& data, const Eigen::Vector3d& query) {
  const Eigen::Vector3d point = to_eigen(data.frame.to_model(data.vertices[0]));
  const double distance = safe_length(query - point);
  const double reach = std::max(query.cwiseAbs().maxCoeff(), point.cwiseAbs().maxCoeff());
  const double slack = 32 * unit_roundoff * reach + data.diagonal * (1 + 4 * unit_roundoff);
  return {{point, data.triangle_of_slot[0]}, {std::max(0.0, next_down(distance - slack)), next_up(distance + slack)}};
}

/// Queries are answered together (`MeasureGroup`) up to this distance from the first of them, and that one starts where
/// the last one ended up to the other distance. In longest edges of the triangle that was found there: eight queries in
/// Morton order beside a scan mostly are within two. Measured there: 3 to 6 edges differ by 3%.
constexpr double group_extent = 5, hint_extent = 8;
/// Fewer are not worth it.
constexpr std::size_t min_group = 3;
/// How many queries are answered one by one, at most, after a group was none: each failure doubles their number.
constexpr std::size_t max_pause = 255;

/// How far the certified lower bound may stay below the nearest distance, in units of `dual_error`: the interval
/// becomes at most 1/16 wider.
constexpr double allowed_loss = 0.25;

/// Queries of one thread: each starts at the triangle that the one before it found, which changes no answer.
class PointQueries {
 public:
  explicit PointQueries(const Bvh::Data& data, std::uint32_t hint = no_slot, const StopToken& stop = {})
      : data_(data), map_(data.frame), kernel_(point_kernel()), hint_(hint), stop_(stop) {}

  ClosestPoint operator()(const Eigen::Vector3d& query) {
    ClosestPoint answer;
    answer_one(query, answer);
    return answer;
  }

  /// Answers several queries: neighbours that follow one another together, as long as that is of use. Throws `Stopped`.
  void answer(std::span<const Eigen::Vector3d> queries, std::span<ClosestPoint> answers) {
    std::size_t alone = 1;  // so many more are answered one by one: the first one, for a hint
    std::size_t pause = 0;
    Group group;
    std::size_t next_look = 0;
    for (std::size_t begin = 0; begin < queries.size();) {
      if (begin >= next_look) {
        stop_.check();
        next_look = begin + queries_between_looks;
      }
      if (alone > 0) {
        answer_one(queries[begin], answers[begin]);
        ++begin;
        --alone;
        continue;
      }
      const std::size_t count = place_neighbours(queries.subspan(begin), group);
      if (count < min_group) {
        alone = std::max<std::size_t>(count, 1);
      } else if (answer_group(group, answers.subspan(begin, count))) {
        begin += count;
        pause = 0;
      } else {
        alone = pause = std::min(2 * pause + count, max_pause);
      }
    }
  }

  [[nodiscard]] std::uint32_t hint() const { return hint_; }

 private:
  /// What mapping a query into the working frame says about it.
  struct Placement {
    double magnitude = 1;
    double error = 0;  ///< of its coordinates
  };

  /// Queries that are answered together.
  struct Group {
    std::array<GroupQuery, max_group_width> queries;
    std::array<Placement, max_group_width> placements;
    std::array<PointDistance, max_group_width> found;
  };

  // Queries and answers are written where they are wanted: copying them took a tenth of the time of a batch.
  void answer_one(const Eigen::Vector3d& query, ClosestPoint& answer) {
    GroupQuery placed;
    const Placement placement = place(query, placed);
    if (!(placement.magnitude <= max_magnitude))  // the mesh is a point beside its distance
      answer = closest_of_point_like(data_, query);
    else
      set_closest(placed, placement, kernel_.one(data_, placed.point, placed.roundings, hint_), answer);
  }

  Placement place(const Eigen::Vector3d& query, GroupQuery& placed) const {
    const Vec3 model{query.x(), query.y(), query.z()};
    if (!(largest_magnitude_of(model) <= largest_coordinate))
      throw InvalidInput("the query point has a coordinate that is not finite or is beyond 2^1000");
    placed.point = map_(model);
    const double magnitude = std::max(1.0, largest_magnitude_of(placed.point));
    // Twice the error, so that the roundings of limits made from it are covered.
    placed.roundings = {2 * primal_error * magnitude, allowed_loss * dual_error * magnitude};
    return {magnitude, data_.frame.error + map_.rounding_of(model)};
  }

  void set_closest(const GroupQuery& query, const Placement& placement, const PointDistance& found,
                   ClosestPoint& closest) {
    hint_ = found.nearest.slot;
    last_ = query.point;
    set_slack(goal_, placement.magnitude, placement.error);
    closest.point.position = to_eigen(map_.to_model(query.point - found.offset));
    closest.point.triangle = data_.triangle_of_slot[found.nearest.slot];
    closest.distance.lower = map_.length_down(std::max(0.0, goal_.proven_lower(found.separated, 0)));
    closest.distance.upper = map_.length_up(goal_.proven_upper(found.nearest.squared, 0));
  }

  /// Places the first queries, as far as they are neighbours of the first one, and returns their number. Forgets the
  /// hint where that one is far from the query before it: a search that begins there takes longer than one that begins
  /// at the root.
  std::size_t place_neighbours(std::span<const Eigen::Vector3d> queries, Group& group) {
    if (hint_ == no_slot) return 0;  // all before were too far away for one
    const Triangle& t = data_.corners[hint_];
    const double edge_squared = squared_length(data_.vertices[t[1]] - data_.vertices[t[0]]);
    const std::size_t max_count = std::min(queries.size(), kernel_.group_width);
    Vec3 first = last_;
    for (std::size_t count = 0; count < max_count; ++count) {
      group.placements[count] = place(queries[count], group.queries[count]);
      if (is_far(group.queries[count].point)) return count;
      const double squared = squared_length(group.queries[count].point - first);
      if (count == 0) {
        if (squared > hint_extent * hint_extent * edge_squared) hint_ = no_slot;
        first = group.queries[0].point;
      } else if (squared > group_extent * group_extent * edge_squared) {
        return count;
      }
    }
    return max_count;
  }

  /// Answers the neighbours that were placed. False, and no answer, where that takes longer than one by one.
  bool answer_group(Group& group, std::span<ClosestPoint> answers) {
    const std::size_t count = answers.size();
    const std::span<PointDistance> found = std::span(group.found).first(count);
    if (!kernel_.group(data_, std::span(group.queries).first(count), hint_, found)) return false;
    for (std::size_t i = 0; i < count; ++i) set_closest(group.queries[i], group.placements[i], found[i], answers[i]);
    return true;
  }

  const Bvh::Data& data_;
  FrameMap map_;
  Goal goal_;  ///< for its rounding slacks, which are those of the query at hand
  PointKernel kernel_;
  std::uint32_t hint_;
  Vec3 last_;  ///< the query that found it
  StopToken stop_;
};

/// Answers the queries with these indices, one after another.
void answer_in_order(PointQueries& ask, std::span<const Eigen::Vector3d> queries, std::span<const std::uint32_t> order,
                     std::span<ClosestPoint> answers) {
  std::vector<Eigen::Vector3d> ordered(order.size());
  std::transform(order.begin(), order.end(), ordered.begin(), [&](std::uint32_t i) { return queries[i]; });
  std::vector<ClosestPoint> found(order.size());
  ask.answer(ordered, found);
  for (std::size_t i = 0; i < order.size(); ++i) answers[order[i]] = found[i];
}

/// What a thread found last: where its next query begins if it asks the same tree.
struct LastFound {
  std::uint64_t serial = 0;  ///< of the tree; 0 is none
  std::uint32_t slot = 0;
};

}  // namespace

ClosestPoint closest_point(const Bvh& bvh, const Eigen::Vector3d& query) {
  check_floating_point_model();
  thread_local LastFound last;
  const Bvh::Data& data = bvh.data();
  PointQueries ask(data, last.serial == data.serial ? last.slot : no_slot);
  const ClosestPoint answer = ask(query);
  last = {data.serial, ask.hint()};
  return answer;
}

std::vector<ClosestPoint> closest_points(const Bvh& bvh, std::span<const Eigen::Vector3d> queries,
                                         const QueryOptions& options) {
  check_floating_point_model();
  std::vector<ClosestPoint> answers(queries.size());
  const std::vector<std::uint32_t> order = order_of_queries(queries);
  const auto wanted = static_cast<std::size_t>(thread_count(options.threads));
  const std::size_t useful = 1 + queries.size() / queries_per_task;
  with_team(static_cast<int>(std::min(wanted, useful)), [&] {
    for_each_range(queries.size(), queries_per_task, [&](std::size_t begin, std::size_t end) {
      PointQueries ask(bvh.data(), no_slot, options.stop);
      if (order.empty())
        ask.answer(queries.subspan(begin, end - begin), std::span(answers).subspan(begin, end - begin));
      else
        answer_in_order(ask, queries, std::span(order).subspan(begin, end - begin), answers);
    });
  });
  return answers;
}

}  // namespace meshbound
