// SPDX-License-Identifier: MIT
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "bvh/bvh_data.h"
#include "distance/kernel/point_query.h"
#include "distance/kernel/search_kernel.h"
#include "distance/shortcuts/point_like.h"
#include "geometry/eigen_vec3.h"
#include "geometry/magnitude.h"
#include "meshbound/error.h"
#include "numeric/rounding.h"
#include "numeric/tasks.h"

namespace meshbound {
namespace {

/// Queries that make one task: some half a millisecond of work.
constexpr std::size_t queries_per_task = 1024;

/// The answer where the mesh is a point beside its distance: see `distance_to_point_like`.
ClosestPoint closest_of_point_like(const Bvh::Data& data, const Eigen::Vector3d& query) {
  const Eigen::Vector3d point = to_eigen(data.frame.to_model(data.vertices[0]));
  const Eigen::Vector3d apart = query - point;
  const double distance = std::hypot(apart.x(), apart.y(), apart.z());
  const double reach = std::max(query.cwiseAbs().maxCoeff(), point.cwiseAbs().maxCoeff());
  const double slack = 32 * unit_roundoff * reach + data.diagonal * (1 + 4 * unit_roundoff);
  return {{point, data.triangle_of_slot[0]}, {std::max(0.0, next_down(distance - slack)), next_up(distance + slack)}};
}

/// How far the certified lower bound may stay below the nearest distance, in units of `dual_error`: the interval
/// becomes at most 1/16 wider.
constexpr double allowed_loss = 0.25;

/// Queries of one thread: each starts at the triangle that the one before it found, which changes no answer.
class PointQueries {
 public:
  explicit PointQueries(const Bvh::Data& data, std::uint32_t hint = no_slot)
      : data_(data), map_(data.frame), measure_(point_kernel()), hint_(hint) {}

  ClosestPoint operator()(const Eigen::Vector3d& query) {
    const Vec3 model{query.x(), query.y(), query.z()};
    if (!(largest_magnitude_of(model) <= largest_coordinate))
      throw InvalidInput("the query point has a coordinate that is not finite or is beyond 2^1000");
    const Vec3 p = map_(model);
    const double magnitude = std::max(1.0, largest_magnitude_of(p));
    if (!(magnitude <= max_magnitude)) return closest_of_point_like(data_, query);
    // Twice the error, so that the roundings of limits made from it are covered.
    const PointRoundings roundings{2 * primal_error * magnitude, allowed_loss * dual_error * magnitude};
    const PointDistance found = measure_(data_, p, roundings, hint_);
    hint_ = found.nearest.slot;
    Goal goal;
    set_slack(goal, magnitude, data_.frame.error + map_.rounding_of(model));
    const double upper = goal.proven_upper(found.nearest.squared, 0);
    return {{to_eigen(map_.to_model(p - found.offset)), data_.triangle_of_slot[found.nearest.slot]},
            {map_.length_down(std::max(0.0, goal.proven_lower(found.separated, 0))), map_.length_up(upper)}};
  }

  [[nodiscard]] std::uint32_t hint() const { return hint_; }

 private:
  const Bvh::Data& data_;
  FrameMap map_;
  MeasurePoint measure_;
  std::uint32_t hint_;
};

/// What a thread found last: where its next query begins if it asks the same tree.
struct LastFound {
  std::uint64_t serial = 0;  ///< of the tree; 0 is none
  std::uint32_t slot = 0;
};

}  // namespace

ClosestPoint closest_point(const Bvh& bvh, const Eigen::Vector3d& query) {
  thread_local LastFound last;
  const Bvh::Data& data = bvh.data();
  PointQueries ask(data, last.serial == data.serial ? last.slot : no_slot);
  const ClosestPoint answer = ask(query);
  last = {data.serial, ask.hint()};
  return answer;
}

std::vector<ClosestPoint> closest_points(const Bvh& bvh, std::span<const Eigen::Vector3d> queries,
                                         const QueryOptions& options) {
  std::vector<ClosestPoint> answers(queries.size());
  const auto wanted = static_cast<std::size_t>(options.threads > 0 ? options.threads : omp_get_max_threads());
  const std::size_t useful = 1 + queries.size() / queries_per_task;
  with_team(static_cast<int>(std::min(wanted, useful)), [&] {
    for_each_range(queries.size(), queries_per_task, [&](std::size_t begin, std::size_t end) {
      PointQueries ask(bvh.data());
      for (std::size_t i = begin; i < end; ++i) answers[i] = ask(queries[i]);
    });
  });
  return answers;
}

}  // namespace meshbound
