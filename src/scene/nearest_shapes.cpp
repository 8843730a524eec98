// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <queue>

#include "distance/search/one_sided.h"
#include "meshbound/error.h"
#include "meshbound/pose.h"
#include "meshbound/stop_token.h"
#include "numeric/checked_seconds.h"
#include "scene/shape.h"

namespace meshbound {

/// A candidate in one alignment, and the bounds of its distance, which stages of growing cost narrow.
struct ShapeTrial {
  /// What the lower bound is from: extents; a few points of the candidate, which need no tree of it; more of them.
  enum class Stage { Extents, FewSamples, Samples };

  Bounds distance;
  Stage stage = Stage::Extents;
  std::uint32_t index;  ///< index of the candidate
  std::uint32_t way;    ///< which of its alignments
};

namespace {

/// The smallest lower bound on top of a queue.
struct ByLower {
  bool operator()(const ShapeTrial& x, const ShapeTrial& y) const {
    if (x.distance.lower != y.distance.lower) return x.distance.lower > y.distance.lower;
    return x.index != y.index ? x.index > y.index : x.way > y.way;
  }
};
using TrialQueue = std::priority_queue<ShapeTrial, std::vector<ShapeTrial>, ByLower>;

}  // namespace

class ShapeSearch {
 public:
  ShapeSearch(const Shape& query, std::span<const Shape> candidates, const SimilarityOptions& options)
      : query_(query),
        candidates_(candidates),
        options_(options),
        stop_(StopToken{.cancel = options.distance.cancel}.until(StopToken::Clock::now(),
                                                                 checked_seconds(options.distance.budget.seconds))) {}

  SimilarShapes run() {
    for (std::uint32_t i = 0; i < candidates_.size(); ++i)
      for (std::uint32_t way = 0; way < (options_.align ? 4U : 1U); ++way)
        unsampled_.push({.distance = {by_extents(i, way), infinity}, .index = i, .way = way});
    stats().alignments = unsampled_.size();
    try {
      while (follow_best()) stop_.check();
    } catch (const Stopped&) {
      result_.complete = false;
    }
    for (const std::size_t i : listed()) {
      const ShapeTrial& trial = measured_[i];
      result_.nearest.push_back({trial.index, trial.distance, alignment(trial), is_narrow(trial)});
    }
    if (result_.complete) count_ended();
    return std::move(result_);
  }

 private:
  static constexpr double infinity = std::numeric_limits<double>::infinity();

  /// Takes one trial a step further; false where none needs it.
  bool follow_best() {
    const double sampled = sampled_.empty() ? infinity : lower(sampled_);
    if (!unsampled_.empty() && lower(unsampled_) <= std::min(limit_, sampled)) {
      sample();
      return true;
    }
    if (sampled <= limit_ && !sampled_.empty()) {
      measure_nearest();
      return true;
    }
    return false;
  }

  static double lower(const TrialQueue& trials) { return trials.top().distance.lower; }

  /// The error bound of a distance with this upper bound.
  [[nodiscard]] double error_bound_at(double upper) const {
    return std::max(options_.error_bound, options_.relative_error_bound * upper);
  }
  [[nodiscard]] bool is_narrow(const ShapeTrial& trial) const {
    const auto [lower, upper] = trial.distance;
    return std::isfinite(upper) && upper - lower <= error_bound_at(upper);
  }

  /// A bound of the rounding of normalised coordinates, of a rotation and of three products. Coordinates are below 2^8
  /// for a shape whose mean radius is 1, unless it is a needle, whose `size` is larger accordingly.
  [[nodiscard]] static double rounding(double size) { return 0x1p-40 * std::max(1.0, size); }

  /// Signs of the axes in each of the 4 proper rotations that keep them.
  [[nodiscard]] static std::array<double, 3> signs(std::uint32_t way) {
    const double first = (way & 1) != 0 ? -1 : 1, second = (way & 2) != 0 ? -1 : 1;
    return {first, second, first * second};
  }

  [[nodiscard]] Pose alignment(const ShapeTrial& trial) const {
    Pose pose = Pose::Identity();
    if (!options_.align) return pose;
    const auto [x, y, z] = signs(trial.way);
    pose.linear() = query_.axes() * Eigen::Vector3d(x, y, z).asDiagonal() * candidates_[trial.index].axes().transpose();
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

  /// Takes the unsampled trial with the smallest lower bound one stage further.
  void sample() {
    using Stage = ShapeTrial::Stage;
    ShapeTrial trial = unsampled_.top();
    unsampled_.pop();
    const std::span<const Eigen::Vector3d> samples(candidates_[trial.index].impl_->samples);
    const std::size_t few = std::min(samples.size(), few_samples);
    const bool is_first = trial.stage == Stage::Extents;
    raise(trial, is_first ? samples.first(few) : samples.subspan(few), alignment(trial), query_);
    trial.stage = is_first ? Stage::FewSamples : Stage::Samples;
    (is_first ? unsampled_ : sampled_).push(trial);
  }

  /// Raises a lower bound to the largest distance of points, moved by `pose`, to a shape; stops once it is too large to
  /// matter.
  void raise(ShapeTrial& trial, std::span<const Eigen::Vector3d> points, const Pose& pose, const Shape& to) {
    double& lower = trial.distance.lower;
    for (std::size_t i = 0; i < points.size() && !(lower > limit_); ++i) {
      const Eigen::Vector3d query = pose * points[i];
      lower = std::max(lower, closest_point(to.tree(), query).distance.lower - rounding(query.norm()));
      ++stats().closest_point_queries;
    }
  }

  /// Measures the trial with the smallest lower bound, unless it is further than the limit. As all that are measured
  /// are as narrow as their error bounds, none of them is nearer than the upper bound of one before it minus the error
  /// bound of that.
  void measure_nearest() {
    ShapeTrial trial = sampled_.top();
    sampled_.pop();
    if (std::isfinite(limit_) && is_too_far(trial)) {
      ++stats().ended_by_decision;
      return;
    }
    ++stats().measured;
    if (!is_narrow(trial)) measure(trial, error_bound_at(trial.distance.lower));
    measured_.push_back(trial);
    sort_measured();
  }

  /// Whether a trial is further than the limit; sets its upper bound if it is proven not to be. Vertices are asked
  /// first: most of the candidates that come so far are like the query all over, so that only a full search tells them
  /// from the nearest; but often a vertex does.
  bool is_too_far(ShapeTrial& trial) {
    const double by_candidate = trial.distance.lower;
    raise(trial, query_.impl_->samples, alignment(trial).inverse(), candidates_[trial.index]);
    const bool query_is_further = trial.distance.lower > by_candidate;
    const PlacedModel query(query_.tree()), candidate(candidates_[trial.index].tree(), alignment(trial));
    const DistanceOptions options = search_options();
    double upper = 0;
    for (const auto search : {bound_by_vertices, search_one_sided}) {
      upper = 0;
      for (const bool from_query : {query_is_further, !query_is_further}) {
        if (trial.distance.lower > limit_) return true;
        OneSidedTask task{.a = from_query ? query : candidate, .b = from_query ? candidate : query, .options = options};
        task.tolerance = limit_;
        task.decide_only = true;
        const OneSidedDistance found = search(task);
        count(found);
        trial.distance.lower = std::max(trial.distance.lower, found.bounds.lower);
        upper = std::max(upper, found.bounds.upper);
      }
    }
    if (upper <= limit_) trial.distance.upper = upper;
    return trial.distance.lower > limit_;
  }

  void measure(ShapeTrial& trial, double error_bound) {
    DistanceOptions options = search_options();
    options.error_bound = error_bound;
    const HausdorffDistance found = hausdorff_distance(
        PlacedModel(query_.tree()), PlacedModel(candidates_[trial.index].tree(), alignment(trial)), options);
    count(found.a_to_b);
    count(found.b_to_a);
    trial.distance.lower = std::max(trial.distance.lower, found.bounds.lower);
    trial.distance.upper = std::min(trial.distance.upper, found.bounds.upper);
  }

  [[nodiscard]] DistanceOptions search_options() const {
    DistanceOptions options = options_.distance;
    options.tolerance.reset();
    options.progress = nullptr;
    options.budget.seconds = stop_.seconds_left();
    return options;
  }

  /// The measured trials that are the nearest of their candidates, as many as are wanted.
  [[nodiscard]] std::vector<std::size_t> listed() const {
    std::vector<std::size_t> list;
    for (std::size_t i = 0; i < measured_.size() && list.size() < options_.count; ++i)
      if (std::none_of(list.begin(), list.end(),
                       [&](std::size_t j) { return measured_[j].index == measured_[i].index; }))
        list.push_back(i);
    return list;
  }

  void sort_measured() {
    std::sort(measured_.begin(), measured_.end(), [](const ShapeTrial& x, const ShapeTrial& y) {
      if (x.distance.upper != y.distance.upper) return x.distance.upper < y.distance.upper;
      return x.index != y.index ? x.index < y.index : x.way < y.way;
    });
    const std::vector<std::size_t> list = listed();
    if (list.size() < options_.count) return;
    const double upper = measured_[list.back()].distance.upper;
    limit_ = std::max(0.0, upper - error_bound_at(upper));
  }

  void count_ended() {
    for (; !unsampled_.empty(); unsampled_.pop())
      ++(unsampled_.top().stage == ShapeTrial::Stage::Extents ? stats().ended_by_extents : stats().ended_by_samples);
    stats().ended_by_samples += sampled_.size();
  }

  void count(const OneSidedDistance& side) { stats().closest_point_queries += side.stats.closest_point_queries; }
  SimilarityStats& stats() { return result_.stats; }

  const Shape& query_;
  std::span<const Shape> candidates_;
  const SimilarityOptions& options_;
  StopToken stop_;
  TrialQueue unsampled_, sampled_;
  std::vector<ShapeTrial> measured_;  ///< by upper bound
  /// Once as many shapes are measured as are wanted: a candidate with a larger lower bound than this cannot be nearer
  /// than the last of them by more than the error bound.
  double limit_ = infinity;
  SimilarShapes result_;
};

SimilarShapes nearest_shapes(const Shape& query, std::span<const Shape> candidates, const SimilarityOptions& options) {
  if (options.count == 0) throw InvalidInput("the number of shapes wanted must be 1 or more");
  if (!(options.error_bound >= 0)) throw InvalidInput("the error bound must be a length of 0 or more");
  if (!(options.relative_error_bound >= 0 && options.relative_error_bound < 1))
    throw InvalidInput("the relative error bound must be a share of 0 or more, below 1");
  return ShapeSearch(query, candidates, options).run();
}

}  // namespace meshbound
