// SPDX-License-Identifier: MIT
#include "meshbound/texture_deviation.h"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "distance/larger_bounds.h"
#include "geometry/boxes.h"
#include "meshbound/error.h"
#include "meshbound/mesh_summary.h"
#include "numeric/rounding.h"
#include "numeric/tasks.h"
#include "numeric/thread_count.h"
#include "texture/charts.h"
#include "texture/line_cover.h"
#include "texture/near_cover.h"
#include "texture/single_coordinates.h"
#include "texture/surface_area.h"
#include "texture/texture_comparison.h"
#include "texture/tiny_meshes.h"
#include "texture/triangle_deviation.h"

namespace meshbound {
namespace {

constexpr double default_share = 1e-6;    ///< of the diagonal: the error bound where none is given
constexpr double reach_share = 1.0 / 64;  ///< of the diagonal: the reach of the first look where no tolerance is given
constexpr double precision_share = 1.0 / 16;  ///< of the error bound: the precision of a single distance
constexpr std::size_t grain = 32;             ///< triangles that a thread takes at once

/// Share of a lower bound: upper bounds below it are not told apart. Where a mesh changes little these serve its next
/// measurement as well, whose lower bound may be less.
constexpr double far_below = 0.9;

/// Computes the one-sided texture deviation from A to B.
class Direction {
 public:
  /// `reach` is how far a first look goes; `bounds` is what is known already, and is made complete.
  Direction(const Charts& a, const Charts& b, const ExactUnits& units, double error_bound, double reach,
            const TextureDeviationOptions& options, TriangleBounds& bounds)
      : a_(a),
        b_(b),
        options_(options),
        reach_(reach),
        upper_(bounds.upper),
        shares_(bounds.uncovered),
        is_refined_(a.triangles().size(), 0) {
    const int threads = thread_count(options.threads);
    for (int k = 0; k < threads; ++k) workspaces_.emplace_back(units);
    goal_.error_bound = error_bound;
    goal_.precision = precision_share * error_bound;
    goal_.max_pieces = options.max_pieces;
    goal_.reach = reach;
    goal_.stop = options.stop;
  }

  OneSidedTextureDeviation run() {
    options_.stop.check();
    pairs_.assign(upper_.size(), 0);
    bound_single_coordinates();
    const std::vector<std::size_t> unknown_before = unknown();
    for (const bool is_first : {true, false}) {
      look_at_near(part_of(unknown_before, is_first));
      find_lower_bound();
    }
    refine(unknown(), rough_error_bound());
    refine(open(), goal_.error_bound);
    if (!witness_) find_witness();
    OneSidedTextureDeviation result;
    result.bounds = {goal_.lower, goal_.lower};
    for (const double upper : upper_) result.bounds.upper = std::max(result.bounds.upper, upper);
    result.witness = witness_;
    result.exceeding = std::move(exceeding_);
    result.uncovered = uncovered_share_of(a_.mesh(), shares_);
    if (result.bounds.upper - result.bounds.lower > goal_.error_bound) result.outcome = outcome_of_wide();
    result.pairs = std::accumulate(pairs_.begin(), pairs_.end(), std::uint64_t{0});
    result.pieces = pieces_;
    return result;
  }

 private:
  /// What one thread works with.
  struct Workspace {
    explicit Workspace(const ExactUnits& units) : overlay(units), line_cover(units) {}
    Overlay overlay;
    Covering covering;
    NearCover near_cover;
    LineCover line_cover;
    ChartCandidates candidates;
  };

  void find_candidates(std::size_t triangle, Workspace& work) const {
    b_.find_candidates(a_.triangles()[triangle], reach_, work.candidates);
  }

  [[nodiscard]] FindOthers others_of(std::size_t triangle, Workspace& work) const {
    return [this, &a = a_.triangles()[triangle], &found = work.candidates] {
      b_.find_others(a, found);
      return std::span<const ChartTriangle* const>(found.others);
    };
  }

  /// Starts the overlay of a triangle with the near ones of the candidates that were found last.
  void overlay_near(std::size_t triangle, Workspace& work) const {
    work.overlay.begin(a_.triangles()[triangle]);
    for (const ChartTriangle* b : work.candidates.near) work.overlay.add(*b);
  }

  /// Whether the bounds of a triangle still have to be refined.
  [[nodiscard]] bool is_open(std::size_t triangle) const {
    const double enough = goal_.lower + goal_.error_bound;
    return is_refined_[triangle] == 0 &&
           upper_[triangle] > (options_.tolerance ? std::min(*options_.tolerance, enough) : enough);
  }

  [[nodiscard]] bool exceeds(const TriangleDeviation& found) const {
    return options_.tolerance && found.bounds.upper > *options_.tolerance;
  }

  /// What is far below the lower bound of all is not told apart.
  [[nodiscard]] double min_upper() const {
    return far_below * std::min(goal_.lower, options_.tolerance.value_or(HUGE_VAL));
  }

  template <class Work>
  void for_triangles(std::size_t count, std::size_t at_once, const Work& work) {
    with_team(static_cast<int>(workspaces_.size()), [&] {
      for_each_range(count, at_once, [&](std::size_t begin, std::size_t end) {
        options_.stop.check();
        Workspace& workspace = workspaces_[static_cast<std::size_t>(omp_get_thread_num())];
        for (std::size_t i = begin; i < end; ++i) work(i, workspace);
      });
    });
  }

  /// Many triangles are covered by few near ones: an upper bound, and no uncovered area.
  void look_at_near(const std::vector<std::size_t>& triangles) {
    for_triangles(triangles.size(), grain, [&](std::size_t k, Workspace& work) {
      const std::size_t i = triangles[k];
      const ChartTriangle& a = a_.triangles()[i];
      if (a.chart == Chart::Point) return;
      find_candidates(i, work);
      if (const auto& copy = work.candidates.copy) {
        upper_[i] = copy->upper;
        pairs_[i] = 1;
        return;
      }
      pairs_[i] = static_cast<std::uint32_t>(work.candidates.near.size());
      const auto upper = a.chart == Chart::Area
                             ? work.near_cover.upper(a, work.candidates.near, min_upper(), goal_.precision)
                             : work.line_cover.upper(a, work.candidates.near, min_upper(), goal_.precision);
      if (upper) upper_[i] = *upper;
    });
  }

  /// Triangles of one texture coordinate are bounded together. Beyond the tolerance each is looked at by itself.
  void bound_single_coordinates() {
    for (const SingleCoordinate& single :
         distances_at_single_coordinates(a_, b_, unknown(), goal_.error_bound, options_)) {
      if (single.lower) raise(*single.lower, single.witness);
      for (std::size_t k = 0; k < single.triangles.size(); ++k)
        if (!options_.tolerance || single.upper[k] <= *options_.tolerance)
          upper_[single.triangles[k]] = single.upper[k];
    }
  }

  /// The first part has triangles from all over the mesh: enough for a lower bound that spares the others most of their
  /// work.
  [[nodiscard]] static std::vector<std::size_t> part_of(const std::vector<std::size_t>& triangles, bool is_first) {
    constexpr std::size_t stride = 8;
    std::vector<std::size_t> part;
    for (std::size_t k = 0; k < triangles.size(); ++k)
      if ((k % stride == 0) == is_first) part.push_back(triangles[k]);
    return part;
  }

  [[nodiscard]] bool is_unknown(std::size_t triangle) const { return !(upper_[triangle] < HUGE_VAL); }

  /// The triangles that near candidates are not known to cover.
  [[nodiscard]] std::vector<std::size_t> unknown() const {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < upper_.size(); ++i)
      if (is_unknown(i)) found.push_back(i);
    return found;
  }

  /// The triangles whose bounds are known but too wide, those with the largest upper bounds first.
  [[nodiscard]] std::vector<std::size_t> open() const {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < upper_.size(); ++i)
      if (!is_unknown(i) && is_open(i)) found.push_back(i);
    std::stable_sort(found.begin(), found.end(), [&](std::size_t p, std::size_t q) { return upper_[p] > upper_[q]; });
    return found;
  }

  /// Looks for a lower bound where the upper bounds are largest, so that the rest need not be bounded below it: among
  /// triangles with an area in the texture first. Those of others are rough where pieces had to bound them: on a
  /// lattice of bars mapped from above a run takes 15 s, and more than 100 where these are looked at first.
  void find_lower_bound() {
    std::vector<std::size_t> worst = open();
    std::stable_partition(worst.begin(), worst.end(),
                          [this](std::size_t i) { return a_.triangles()[i].chart == Chart::Area; });
    worst.resize(std::min(worst.size(), batch_for_lower));
    refine(worst, rough_error_bound());
  }

  /// As long as the lower bound is far too low, rough bounds suffice: they tell where the deviation is largest. With a
  /// tolerance each triangle beyond it counts.
  [[nodiscard]] double rough_error_bound() const {
    return options_.tolerance ? goal_.error_bound : std::max(goal_.error_bound, reach_);
  }

  /// Refines triangles in batches. Every triangle of a batch starts from the lower bound before the batch, so that
  /// results do not depend on the number of threads.
  void refine(std::span<const std::size_t> order, double error_bound) {
    constexpr std::size_t growth = 4, max_batch = 4096;
    std::size_t batch = first_batch;
    for (std::size_t done = 0; done < order.size(); batch = std::min(growth * batch, max_batch)) {
      const std::size_t count = std::min(batch, order.size() - done);
      refine_batch(order.subspan(done, count), error_bound);
      done += count;
    }
  }

  void refine_batch(std::span<const std::size_t> triangles, double error_bound) {
    std::vector<TriangleDeviation> found(triangles.size());
    std::vector<std::optional<TextureWitness>> witnesses(triangles.size());
    DeviationGoal goal = goal_;
    goal.error_bound = error_bound;
    goal.min_upper = min_upper();
    if (options_.tolerance) {
      goal.lower = std::min(goal.lower, *options_.tolerance - goal.error_bound);
      goal.silent = *options_.tolerance;
    }
    for_triangles(triangles.size(), 1, [&](std::size_t k, Workspace& work) {
      if (!is_open(triangles[k])) return;
      find_candidates(triangles[k], work);
      overlay_near(triangles[k], work);
      found[k] = deviation_by_pieces(work.overlay, work.covering, others_of(triangles[k], work), goal);
      pairs_[triangles[k]] += work.overlay.candidates();
      const bool may_be_shown = found[k].bounds.lower >= goal_.lower || exceeds(found[k]);
      if (found[k].far && may_be_shown)
        witnesses[k] = work.overlay.witness(found[k].far->candidate, found[k].far->node);
    });
    for (std::size_t k = 0; k < triangles.size(); ++k) {
      if (found[k].pieces == 0) continue;
      upper_[triangles[k]] = found[k].bounds.upper;
      shares_[triangles[k]] = found[k].uncovered;
      is_refined_[triangles[k]] = error_bound == goal_.error_bound ? 1 : 0;
      gave_up_ = gave_up_ || found[k].gave_up;
      pieces_ += found[k].pieces;
      if (exceeds(found[k]) && witnesses[k]) exceeding_.push_back(*witnesses[k]);
      if (witnesses[k]) raise(found[k].bounds.lower, *witnesses[k]);
    }
  }

  /// Why the bounds are farther apart than they should be.
  [[nodiscard]] Outcome outcome_of_wide() const {
    if (options_.tolerance && goal_.lower > *options_.tolerance) return Outcome::ExceedsTolerance;
    return gave_up_ ? Outcome::BudgetExhausted : Outcome::PrecisionReached;
  }

  void raise(double lower, const TextureWitness& witness) {
    if (witness_ ? lower <= goal_.lower : lower < goal_.lower) return;
    goal_.lower = lower;
    witness_ = witness;
  }

  /// Where no far point was needed: finds one of the triangle with the largest upper bound.
  void find_witness() {
    const auto worst = std::max_element(upper_.begin(), upper_.end());
    if (worst == upper_.end() || *worst < 0) return;
    Workspace& work = workspaces_.front();
    const auto triangle = static_cast<std::size_t>(worst - upper_.begin());
    find_candidates(triangle, work);
    overlay_near(triangle, work);
    const TriangleDeviation found = deviation_at_corners(work.overlay, others_of(triangle, work), goal_);
    if (found.far) raise(found.bounds.lower, work.overlay.witness(found.far->candidate, found.far->node));
  }

  static constexpr std::size_t first_batch = 16;
  /// Triangles that a lower bound is looked for in. Runs of `simplify_with_bound` with a texture execute 1% more with
  /// 16 and 0.1% less with 4 (six models at two tolerances).
  static constexpr std::size_t batch_for_lower = 8;

  const Charts &a_, &b_;
  const TextureDeviationOptions& options_;
  std::vector<Workspace> workspaces_;  ///< by thread
  DeviationGoal goal_;
  double reach_ = 0;                  ///< of the first look, model units
  std::vector<double>& upper_;        ///< by triangle of A
  std::vector<Approximate>& shares_;  ///< by triangle of A: the share of it that B does not cover
  std::vector<std::uint8_t> is_refined_;
  std::vector<std::uint32_t> pairs_;
  std::optional<TextureWitness> witness_;
  std::vector<TextureWitness> exceeding_;
  bool gave_up_ = false;
  std::uint64_t pieces_ = 0;
};

void check_finite(const TexturedMesh& mesh) {
  for (const TexturedTriangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      if (!t.corners[k].allFinite() || !t.coordinates[k].allFinite())
        throw InvalidInput("triangle " + std::to_string(t.triangle) +
                           ": a coordinate or texture coordinate is not finite; repair the mesh");
}

void check_input(const TexturedMesh& a, const TexturedMesh& b) {
  check_floating_point_model();
  check_finite(a);
  check_finite(b);
}

Eigen::AlignedBox3d box_around(const TexturedMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const TexturedTriangle& t : mesh.triangles) box.extend(box_of(t.corners));
  return box;
}

/// The diagonal of A's bounding box; where A is a point, of the one around both meshes.
double size_of(const TexturedMesh& a, const TexturedMesh& b) {
  const double of_a = diagonal_of(box_around(a));
  return of_a > 0 ? of_a : diagonal_of(box_around(a).merged(box_around(b)));
}

/// `known` by direction; it is made complete.
TextureDeviation measured(const Charts& charts_a, const Charts& charts_b, const TextureDeviationOptions& options,
                          std::array<TriangleBounds, 2>& known) {
  const double size = size_of(charts_a.mesh(), charts_b.mesh());
  const double error_bound = options.error_bound.value_or(default_share * size);
  if (!(error_bound >= 0)) throw InvalidInput("the error bound must be a length in model units, 0 or more");
  if (options.tolerance && !(*options.tolerance >= 0))
    throw InvalidInput("the texture tolerance must be a length in model units, 0 or more");
  const ExactUnits units = common_units(charts_a, charts_b);
  TextureDeviation result;
  const double reach = options.tolerance.value_or(reach_share * size);
  result.a_to_b = Direction(charts_a, charts_b, units, error_bound, reach, options, known[0]).run();
  result.b_to_a = Direction(charts_b, charts_a, units, error_bound, reach, options, known[1]).run();
  result.bounds = larger(result.a_to_b.bounds, result.b_to_a.bounds);
  return result;
}

}  // namespace

TextureDeviation texture_deviation(const TexturedMesh& a, const TexturedMesh& b,
                                   const TextureDeviationOptions& options) {
  check_input(a, b);
  if (are_tiny(a, b)) return deviation_of_tiny(a, b, options);
  std::array<TriangleBounds, 2> known{bounds_of_equal(a, b), bounds_of_equal(b, a)};
  return measured(Charts(a), Charts(b), options, known);
}

TextureDeviation TextureComparison::measure(std::array<TexturedMesh, 2> meshes,
                                            const TextureDeviationOptions& options) {
  check_input(meshes[0], meshes[1]);
  if (are_tiny(meshes[0], meshes[1])) {
    first_.reset();  // nothing is known of these bounds by triangle
    return deviation_of_tiny(meshes[0], meshes[1], options);
  }
  const bool keeps_first = first_ && meshes[0] == *first_;
  if (keeps_first && meshes[1] == second_) return deviation_;
  std::array<TriangleBounds, 2> known;
  if (first_)
    known = {bounds_left(bounds_[0], *first_, second_, meshes[0], meshes[1]),
             bounds_left(bounds_[1], second_, *first_, meshes[1], meshes[0])};
  else
    known = {bounds_of_equal(meshes[0], meshes[1]), bounds_of_equal(meshes[1], meshes[0])};
  const auto first = keeps_first ? first_ : std::make_shared<const TexturedMesh>(std::move(meshes[0]));
  const auto charts = keeps_first ? charts_of_first_ : std::make_shared<const Charts>(*first);
  const TextureDeviation deviation = measured(*charts, Charts(meshes[1]), options, known);
  first_ = first;  // not before: the measurement may have been stopped
  charts_of_first_ = charts;
  second_ = std::move(meshes[1]);
  deviation_ = deviation;
  bounds_ = std::move(known);
  return deviation_;
}

}  // namespace meshbound
