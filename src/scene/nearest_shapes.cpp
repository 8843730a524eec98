// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

#include "distance/search/one_sided.h"
#include "meshbound/error.h"
#include "meshbound/motion.h"
#include "meshbound/stop_token.h"
#include "scene/shape.h"

namespace meshbound {

/// A candidate in one alignment, and its lower bound, which stages of growing cost raise.
struct ShapeTrial {
  /// How the lower bound was found: from extents; from points of the candidate, which needs no tree of it; from points
  /// of the query as well.
  enum class Stage { Extents, SamplesOfCandidate, SamplesOfBoth };

  double lower;  ///< of the distance, by the stages passed
  Stage stage;
  std::uint32_t index;  ///< index of the candidate
  std::uint32_t way;    ///< which of its alignments

  bool operator<(const ShapeTrial& other) const {
    if (lower != other.lower) return lower > other.lower;
    return index != other.index ? index > other.index : way > other.way;
  }
};

class ShapeSearch {
 public:
  ShapeSearch(const Shape& query, std::span<const Shape> candidates, const SimilarityOptions& options)
      : query_(query),
        candidates_(candidates),
        options_(options),
        stop_(StopToken{.cancel = options.distance.cancel}.until(StopToken::Clock::now(),
                                                                 options.distance.budget.seconds)) {}

  SimilarShapes run() {
    for (std::uint32_t i = 0; i < candidates_.size(); ++i)
      for (std::uint32_t way = 0; way < (options_.align ? 4U : 1U); ++way)
        trials_.push({by_extents(i, way), ShapeTrial::Stage::Extents, i, way});
    stats().alignments = trials_.size();
    try {
      while (!trials_.empty() && !(trials_.top().lower > limit_)) follow_best();
    } catch (const Stopped&) {
      result_.complete = false;
    }
    for (; !trials_.empty() && result_.complete; trials_.pop())
      ++(trials_.top().stage == ShapeTrial::Stage::Extents ? stats().ended_by_extents : stats().ended_by_samples);
    if (result_.nearest.size() > options_.count) result_.nearest.resize(options_.count);
    return std::move(result_);
  }

 private:
  /// Takes the trial with the smallest lower bound one stage further.
  void follow_best() {
    stop_.check();
    const ShapeTrial trial = trials_.top();
    trials_.pop();
    if (trial.stage == ShapeTrial::Stage::SamplesOfBoth)
      measure(trial);
    else
      trials_.push(sampled(trial));
  }

  /// A bound of the rounding of normalised coordinates, of a rotation and of three products. Coordinates are below 2^8
  /// for a shape whose mean radius is 1, unless it is a needle, whose `size` is larger accordingly.
  [[nodiscard]] static double rounding(double size) { return 0x1p-40 * std::max(1.0, size); }

  /// Signs of the axes in each of the 4 proper rotations that keep them.
  [[nodiscard]] static std::array<double, 3> signs(std::uint32_t way) {
    const double first = (way & 1) != 0 ? -1 : 1, second = (way & 2) != 0 ? -1 : 1;
    return {first, second, first * second};
  }

  [[nodiscard]] Eigen::Isometry3d alignment(std::uint32_t index, std::uint32_t way) const {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    if (!options_.align) return pose;
    const auto [x, y, z] = signs(way);
    pose.linear() = query_.axes() * Eigen::Vector3d(x, y, z).asDiagonal() * candidates_[index].axes().transpose();
    return pose;
  }

  /// Lower bound by extents: no point of the other shape is nearer to a point that is furthest along an axis than their
  /// extents differ.
  [[nodiscard]] double by_extents(std::uint32_t index, std::uint32_t way) const {
    const Shape::Impl &mine = *query_.impl_, &theirs = *candidates_[index].impl_;
    const Extents& a = options_.align ? mine.along_axes : mine.along_world;
    const Extents& b = options_.align ? theirs.along_axes : theirs.along_world;
    const std::array<double, 3> sign = signs(options_.align ? way : 0);
    double largest = 0, size = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double lo = sign[k] > 0 ? b.lo[k] : -b.hi[k], hi = sign[k] > 0 ? b.hi[k] : -b.lo[k];
      largest = std::max({largest, std::fabs(a.lo[k] - lo), std::fabs(a.hi[k] - hi)});
      size = std::max({size, std::fabs(a.lo[k]), std::fabs(a.hi[k]), std::fabs(lo), std::fabs(hi)});
    }
    return std::max(0.0, largest - rounding(size));
  }

  /// Largest distance of the points, moved by `pose`, to a shape; stops once it is too large to matter.
  double sample(const std::vector<Eigen::Vector3d>& points, const Eigen::Isometry3d& pose, const Shape& to,
                double lower) {
    for (std::size_t i = 0; i < points.size() && !(lower > limit_); ++i) {
      const Eigen::Vector3d query = pose * points[i];
      lower = std::max(lower, closest_point(to.tree(), query).distance.lower - rounding(query.norm()));
      ++stats().closest_point_queries;
    }
    return lower;
  }

  ShapeTrial sampled(ShapeTrial trial) {
    const Shape& candidate = candidates_[trial.index];
    const Eigen::Isometry3d pose = alignment(trial.index, trial.way);
    if (trial.stage == ShapeTrial::Stage::Extents) {
      trial.lower = sample(candidate.impl_->samples, pose, query_, trial.lower);
      trial.stage = ShapeTrial::Stage::SamplesOfCandidate;
    } else {
      trial.lower = sample(query_.impl_->samples, pose.inverse(), candidate, trial.lower);
      trial.stage = ShapeTrial::Stage::SamplesOfBoth;
    }
    return trial;
  }

  /// Whether a vertex of either shape is too far from the other one. Most of the candidates that come so far are like
  /// the query all over, so that only a full search tells them from the nearest; but often a vertex does.
  bool has_far_vertex(const PlacedModel& candidate, const DistanceOptions& options) {
    const PlacedModel query(query_.tree());
    for (const bool from_query : {true, false}) {
      OneSidedTask task{.a = from_query ? query : candidate, .b = from_query ? candidate : query, .options = options};
      task.tolerance = limit_;
      task.decide_only = true;
      const OneSidedDistance found = bound_by_vertices(task);
      count(found);
      if (found.bounds.lower > limit_) return true;
    }
    return false;
  }

  void measure(const ShapeTrial& trial) {
    MovingPair pair(query_.tree(), candidates_[trial.index].tree());
    const Eigen::Isometry3d identity = Eigen::Isometry3d::Identity(), pose = alignment(trial.index, trial.way);
    DistanceOptions options = options_.distance;
    options.tolerance.reset();
    options.error_bound = options_.error_bound;
    options.progress = nullptr;
    options.budget.seconds = stop_.seconds_left();
    if (std::isfinite(limit_)) {
      if (has_far_vertex({candidates_[trial.index].tree(), pose}, options)) {
        ++stats().ended_by_decision;
        return;
      }
      const ToleranceCheck check = pair.check_tolerance(identity, pose, limit_, options);
      count(check.a_to_b);
      count(check.b_to_a);
      if (check.verdict == Verdict::Exceeds) {
        ++stats().ended_by_decision;
        return;
      }
    }
    const HausdorffDistance distance = pair.hausdorff_distance(identity, pose, options);
    count(distance.a_to_b);
    count(distance.b_to_a);
    ++stats().measured;
    const bool converged = distance.bounds.upper - distance.bounds.lower <= options_.error_bound;
    offer({trial.index, distance.bounds, pose, converged});
  }

  /// Keeps the best alignment of each candidate, ordered by upper bound.
  void offer(const SimilarShape& shape) {
    std::vector<SimilarShape>& nearest = result_.nearest;
    const auto nearer = [](const SimilarShape& x, const SimilarShape& y) {
      return x.distance.upper != y.distance.upper ? x.distance.upper < y.distance.upper : x.index < y.index;
    };
    const auto same = std::find_if(nearest.begin(), nearest.end(),
                                   [&](const SimilarShape& other) { return other.index == shape.index; });
    if (same == nearest.end())
      nearest.push_back(shape);
    else if (nearer(shape, *same))
      *same = shape;
    std::sort(nearest.begin(), nearest.end(), nearer);
    if (nearest.size() >= options_.count)
      limit_ = std::max(0.0, nearest[options_.count - 1].distance.upper - options_.error_bound);
  }

  void count(const OneSidedDistance& side) { stats().closest_point_queries += side.stats.closest_point_queries; }
  SimilarityStats& stats() { return result_.stats; }

  const Shape& query_;
  std::span<const Shape> candidates_;
  const SimilarityOptions& options_;
  StopToken stop_;
  std::priority_queue<ShapeTrial> trials_;  ///< the smallest lower bound first
  /// Once as many shapes are found as are wanted: a candidate with a larger lower bound than this cannot be nearer than
  /// the last of them by more than the error bound.
  double limit_ = std::numeric_limits<double>::infinity();
  SimilarShapes result_;
};

SimilarShapes nearest_shapes(const Shape& query, std::span<const Shape> candidates, const SimilarityOptions& options) {
  if (options.count == 0) throw InvalidInput("the number of shapes wanted must be 1 or more");
  if (!(options.error_bound >= 0)) throw InvalidInput("the error bound must be a length of 0 or more");
  return ShapeSearch(query, candidates, options).run();
}

}  // namespace meshbound
