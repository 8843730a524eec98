// SPDX-License-Identifier: MIT
#include "meshbound/texture_deviation.h"

#include <omp.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "meshbound/error.h"
#include "numeric/rounding.h"
#include "numeric/tasks.h"
#include "texture/charts.h"
#include "texture/surface_area.h"
#include "texture/triangle_deviation.h"

namespace meshbound {
namespace {

constexpr double default_share = 1e-6;    ///< of the diagonal: the error bound where none is given
constexpr double reach_share = 1.0 / 64;  ///< of the diagonal: the reach of the first look where no tolerance is given
constexpr double precision_share = 1.0 / 16;  ///< of the error bound: the precision of a single distance
constexpr std::size_t grain = 32;             ///< triangles that a thread takes at once

/// Computes the one-sided texture deviation from A to B.
class Direction {
 public:
  /// `reach` is how far a first look goes.
  Direction(const Charts& a, const Charts& b, const ExactUnits& units, double error_bound, double reach,
            const TextureDeviationOptions& options)
      : a_(a),
        b_(b),
        units_(units),
        options_(options),
        reach_(reach),
        bounds_(a.triangles().size()),
        shares_(a.triangles().size()) {
    goal_.error_bound = error_bound;
    goal_.precision = precision_share * error_bound;
    goal_.max_pieces = options.max_pieces;
  }

  OneSidedTextureDeviation run() {
    pairs_.assign(bounds_.size(), 0);
    look_at_near();
    look_at_rest();
    if (!first_ && !bounds_.empty()) look_at(std::array{worst()});
    refine();
    OneSidedTextureDeviation result;
    result.bounds = {goal_.lower, goal_.lower};
    for (const Bounds& b : bounds_) result.bounds.upper = std::max(result.bounds.upper, b.upper);
    result.witness = witness();
    result.exceeding = std::move(exceeding_);
    result.uncovered = uncovered_share_of(a_.mesh(), shares_);
    if (result.bounds.upper - result.bounds.lower > goal_.error_bound)
      result.outcome = gave_up_ ? Outcome::BudgetExhausted : Outcome::PrecisionReached;
    result.pairs = std::accumulate(pairs_.begin(), pairs_.end(), std::uint64_t{0});
    result.pieces = pieces_;
    return result;
  }

 private:
  /// What one thread works with.
  struct Workspace {
    explicit Workspace(const ExactUnits& units) : overlay(units) {}
    Overlay overlay;
    std::vector<std::uint32_t> found;
  };

  void overlay(std::size_t triangle, Workspace& work) const {
    const ChartTriangle& t = a_.triangles()[triangle];
    work.overlay.begin(t);
    b_.add_candidates(t, work.overlay, work.found);
  }

  /// Whether the upper bound of a triangle still has to be lowered.
  [[nodiscard]] bool is_open(std::size_t triangle) const {
    const double enough = goal_.lower + goal_.error_bound;
    return bounds_[triangle].upper > (options_.tolerance ? std::min(*options_.tolerance, enough) : enough);
  }

  [[nodiscard]] bool exceeds(const TriangleDeviation& found) const {
    return options_.tolerance && found.bounds.upper > *options_.tolerance;
  }

  template <class Work>
  void for_triangles(std::size_t count, std::size_t at_once, const Work& work) {
    with_team(options_.threads > 0 ? options_.threads : omp_get_max_threads(), [&] {
      for_each_range(count, at_once, [&](std::size_t begin, std::size_t end) {
        options_.stop.check();
        Workspace workspace(units_);
        for (std::size_t i = begin; i < end; ++i) work(i, workspace);
      });
    });
  }

  /// Many triangles are covered by few near ones: an upper bound, and no uncovered area.
  void look_at_near() {
    for_triangles(bounds_.size(), grain, [&](std::size_t i, Workspace& work) {
      const ChartTriangle& t = a_.triangles()[i];
      if (t.chart != Chart::Area) return;
      work.overlay.begin(t);
      b_.add_near_candidates(t, reach_, work.overlay, work.found);
      pairs_[i] = work.overlay.candidates();
      if (const auto upper = upper_of_complete_cover(work.overlay, goal_.precision)) bounds_[i] = {0, *upper};
    });
  }

  void look_at_rest() {
    std::vector<std::size_t> rest;
    for (std::size_t i = 0; i < bounds_.size(); ++i)
      if (!(bounds_[i].upper < HUGE_VAL)) rest.push_back(i);
    look_at(rest);
  }

  [[nodiscard]] std::size_t worst() const {
    const auto is_smaller = [](const Bounds& p, const Bounds& q) { return p.upper < q.upper; };
    return static_cast<std::size_t>(std::max_element(bounds_.begin(), bounds_.end(), is_smaller) - bounds_.begin());
  }

  /// With all candidates: also a lower bound, from the corners, and the area that none of them covers.
  void look_at(std::span<const std::size_t> triangles) {
    std::vector<std::uint8_t> is_covered(triangles.size(), 0);
    for_triangles(triangles.size(), grain, [&](std::size_t k, Workspace& work) {
      const std::size_t i = triangles[k];
      overlay(i, work);
      const TriangleDeviation known = deviation_by_candidates(work.overlay, goal_.precision).all;
      bounds_[i] = known.bounds;
      is_covered[k] = known.far ? 1 : 0;
      pairs_[i] += work.overlay.candidates();
      shares_[i] = uncovered_share(work.overlay);
    });
    for (std::size_t k = 0; k < triangles.size(); ++k) {
      const std::size_t i = triangles[k];
      if (is_covered[k] == 0 || (first_ && bounds_[i].lower <= goal_.lower)) continue;
      goal_.lower = bounds_[i].lower;
      first_ = i;
    }
  }

  /// Refines the triangles with the largest upper bounds first, in batches. Every triangle of a batch starts from the
  /// lower bound before the batch, so that results do not depend on the number of threads.
  void refine() {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < bounds_.size(); ++i)
      if (is_open(i)) order.push_back(i);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t p, std::size_t q) { return bounds_[p].upper > bounds_[q].upper; });
    constexpr std::size_t first_batch = 16, growth = 4, max_batch = 4096;
    std::size_t batch = first_batch;
    for (std::size_t done = 0; done < order.size(); batch = std::min(growth * batch, max_batch)) {
      if (!is_open(order[done])) return;
      const std::size_t count = std::min(batch, order.size() - done);
      refine(std::span(order).subspan(done, count));
      done += count;
    }
  }

  void refine(std::span<const std::size_t> triangles) {
    std::vector<TriangleDeviation> found(triangles.size());
    std::vector<std::optional<TextureWitness>> witnesses(triangles.size());
    DeviationGoal goal = goal_;
    if (options_.tolerance) goal.lower = std::min(goal.lower, *options_.tolerance - goal.error_bound);
    for_triangles(triangles.size(), 1, [&](std::size_t k, Workspace& work) {
      if (!is_open(triangles[k])) return;
      overlay(triangles[k], work);
      const DeviationByCandidates known = deviation_by_candidates(work.overlay, goal.precision);
      found[k] = deviation_by_pieces(work.overlay, known, goal);
      const bool may_be_shown = found[k].bounds.lower >= goal_.lower || exceeds(found[k]);
      if (found[k].far && may_be_shown)
        witnesses[k] = work.overlay.witness(found[k].far->candidate, found[k].far->node);
    });
    for (std::size_t k = 0; k < triangles.size(); ++k) {
      if (found[k].pieces == 0) continue;
      bounds_[triangles[k]] = found[k].bounds;
      gave_up_ = gave_up_ || found[k].gave_up;
      pieces_ += found[k].pieces;
      if (exceeds(found[k]) && witnesses[k]) exceeding_.push_back(*witnesses[k]);
      if (!witnesses[k] || (witness_ && found[k].bounds.lower <= goal_.lower) || found[k].bounds.lower < goal_.lower)
        continue;
      goal_.lower = found[k].bounds.lower;
      witness_ = witnesses[k];
    }
  }

  /// The witness of the lower bound. Where that was found at a corner of a triangle, the witness is made only here.
  std::optional<TextureWitness> witness() const {
    if (witness_ || !first_) return witness_;
    Workspace work(units_);
    overlay(*first_, work);
    const FarPoint far = *deviation_by_candidates(work.overlay, goal_.precision).all.far;
    return work.overlay.witness(far.candidate, far.node);
  }

  const Charts &a_, &b_;
  ExactUnits units_;
  const TextureDeviationOptions& options_;
  DeviationGoal goal_;
  double reach_ = 0;                 ///< of the first look, model units
  std::vector<Bounds> bounds_;       ///< by triangle of A
  std::vector<Approximate> shares_;  ///< by triangle of A: the share of it that B does not cover
  std::vector<std::uint32_t> pairs_;
  std::optional<std::size_t> first_;  ///< the triangle at a corner of which the lower bound was found
  std::optional<TextureWitness> witness_;
  std::vector<TextureWitness> exceeding_;
  bool gave_up_ = false;
  std::uint64_t pieces_ = 0;
};

void check(const TexturedMesh& mesh) {
  for (const TexturedTriangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      if (!t.corners[k].allFinite() || !t.coordinates[k].allFinite())
        throw InvalidInput("triangle " + std::to_string(t.triangle) +
                           ": a coordinate or texture coordinate is not finite; repair the mesh");
}

double diagonal_of(const TexturedMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const TexturedTriangle& t : mesh.triangles)
    for (const Eigen::Vector3d& p : t.corners) box.extend(p);
  return box.isEmpty() ? 0 : box.diagonal().stableNorm();
}

}  // namespace

TextureDeviation texture_deviation(const TexturedMesh& a, const TexturedMesh& b,
                                   const TextureDeviationOptions& options) {
  check_floating_point_model();
  check(a);
  check(b);
  const double error_bound = options.error_bound.value_or(default_share * diagonal_of(a));
  if (!(error_bound >= 0)) throw InvalidInput("the error bound must be a length in model units, 0 or more");
  if (options.tolerance && !(*options.tolerance >= 0))
    throw InvalidInput("the texture tolerance must be a length in model units, 0 or more");
  const ExactUnits units = units_of(a, b);
  const Charts charts_a(a, units), charts_b(b, units);
  TextureDeviation result;
  const double reach = options.tolerance.value_or(reach_share * diagonal_of(a));
  result.a_to_b = Direction(charts_a, charts_b, units, error_bound, reach, options).run();
  result.b_to_a = Direction(charts_b, charts_a, units, error_bound, reach, options).run();
  result.bounds = {std::max(result.a_to_b.bounds.lower, result.b_to_a.bounds.lower),
                   std::max(result.a_to_b.bounds.upper, result.b_to_a.bounds.upper)};
  return result;
}

}  // namespace meshbound
