// SPDX-License-Identifier: MIT
#include "meshbound/view_levels.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "geometry/affine.h"
#include "meshbound/error.h"
#include "meshbound/mesh_summary.h"
#include "meshbound/mesh_view.h"
#include "meshbound/stop_token.h"
#include "numeric/checked_seconds.h"

namespace meshbound {
namespace {

/// A result holds an error for each number up to the largest.
constexpr std::size_t max_group = 1 << 24;

/// By how much the pose stretches a length at most.
double stretch_of(const ViewInstance& instance, std::size_t number, std::size_t models) {
  const std::string where = "instance " + std::to_string(number);
  if (instance.model >= models) throw InvalidInput(where + ": there is no model " + std::to_string(instance.model));
  require_affine(instance.pose.matrix(), where + ": its pose");
  if (instance.group && *instance.group > max_group)
    throw InvalidInput(where + ": groups are numbered up to " + std::to_string(max_group));
  return Eigen::JacobiSVD<Eigen::Matrix3d>(instance.pose.linear()).singularValues()[0] * (1 + 1e-9);
}

/// Tolerances that the chain of a model may have, model units, ascending.
std::vector<double> ladder_of(double diagonal, const ViewOptions& options) {
  std::vector<double> ladder;
  for (double share = options.finest_share; share <= options.coarsest_share; share *= options.ratio)
    ladder.push_back(share * diagonal);
  return ladder;
}

void check(const ViewOptions& options) {
  if (!(options.finest_share > 0) || !(options.coarsest_share <= 1) ||
      !(options.finest_share <= options.coarsest_share))
    throw InvalidInput("the shares of the diagonal must be positive, at most 1, and the finest not above the coarsest");
  if (!(options.ratio >= 1.01)) throw InvalidInput("the ratio of tolerances of levels must be 1.01 or more");
}

/// The tolerance that each instance needs for each camera, model units.
class Needs {
 public:
  Needs(std::span<const TriangleMesh> models, std::span<const ViewInstance> instances,
        std::span<const ViewCamera> cameras, double pixels)
      : instances_(instances.size()) {
    std::vector<Eigen::AlignedBox3d> boxes;
    for (const TriangleMesh& model : models) {
      validate(model);
      boxes.push_back(used_bounding_box(model));
    }
    for (std::size_t i = 0; i < instances.size(); ++i) stretches_.push_back(stretch_of(instances[i], i, models.size()));
    for (const ViewCamera& camera : cameras)
      for (std::size_t i = 0; i < instances.size(); ++i) {
        const double in_world = view_tolerance(camera, pixels, boxes[instances[i].model], instances[i].pose);
        tolerances_.push_back(stretches_[i] > 0 ? in_world / stretches_[i] : std::numeric_limits<double>::infinity());
      }
  }
  [[nodiscard]] double tolerance(std::size_t camera, std::size_t instance) const {
    return tolerances_[camera * instances_ + instance];
  }
  [[nodiscard]] double stretch(std::size_t instance) const { return stretches_[instance]; }

 private:
  std::size_t instances_;
  std::vector<double> stretches_;   ///< by instance: world units per model unit, at most
  std::vector<double> tolerances_;  ///< by camera, then by instance; infinite: nothing is seen of it
};

/// Steps of the ladder that some camera needs for some instance of the model.
std::set<std::size_t> needed_steps(const std::vector<double>& ladder, std::size_t model,
                                   std::span<const ViewInstance> instances, std::size_t cameras, const Needs& needs) {
  std::set<std::size_t> steps;
  for (std::size_t i = 0; i < instances.size(); ++i) {
    if (instances[i].model != model) continue;
    for (std::size_t camera = 0; camera < cameras; ++camera) {
      const double tolerance = needs.tolerance(camera, i);
      const auto above = std::upper_bound(ladder.begin(), ladder.end(), tolerance);
      if (std::isfinite(tolerance) && above != ladder.begin())
        steps.insert(static_cast<std::size_t>(above - ladder.begin()) - 1);
    }
  }
  return steps;
}

std::vector<ViewLevel> make_levels(const TriangleMesh& model, std::size_t number, const std::vector<double>& ladder,
                                   const std::set<std::size_t>& steps, const LodOptions& options,
                                   const ViewSink& sink) {
  std::vector<ViewLevel> levels{{0, 0, model.triangles.size()}};
  if (steps.empty()) return levels;
  LodChain chain(model, options);
  for (const std::size_t step : steps) {
    const LodLevel level = chain.next(ladder[step]);
    // A coarser level may happen to have a smaller bound than a finer one. Levels are found by errors that ascend, so
    // the larger one is kept.
    const double error = std::max(level.distance->bounds.upper, levels.back().error);
    levels.push_back({ladder[step], error, level.faces()});
    if (sink) sink(number, levels.size() - 1, level);
  }
  return levels;
}

/// The coarsest level within the tolerance; errors ascend along the chain.
std::uint32_t coarsest(const std::vector<ViewLevel>& levels, double tolerance) {
  const auto above = std::upper_bound(levels.begin(), levels.end(), tolerance,
                                      [](double limit, const ViewLevel& level) { return limit < level.error; });
  return static_cast<std::uint32_t>(above - levels.begin()) - 1;
}

ViewChoice choose(std::size_t camera, std::span<const ViewInstance> instances, const Needs& needs,
                  const std::vector<std::vector<ViewLevel>>& models) {
  ViewChoice choice;
  for (std::size_t i = 0; i < instances.size(); ++i) {
    const std::vector<ViewLevel>& levels = models[instances[i].model];
    const double tolerance = needs.tolerance(camera, i);
    choice.level.push_back(std::isfinite(tolerance) ? coarsest(levels, tolerance) : ViewChoice::hidden);
    if (choice.level.back() == ViewChoice::hidden) continue;
    choice.triangles += levels[choice.level.back()].faces;
    choice.full_triangles += levels.front().faces;
  }
  return choice;
}

std::vector<double> errors_of_groups(const ViewChoice& choice, std::span<const ViewInstance> instances,
                                     const Needs& needs, const std::vector<std::vector<ViewLevel>>& models) {
  std::vector<double> errors;
  for (std::size_t i = 0; i < instances.size(); ++i) {
    if (!instances[i].group) continue;
    if (errors.size() <= *instances[i].group) errors.resize(*instances[i].group + 1, 0);
    if (choice.level[i] == ViewChoice::hidden) continue;
    double& error = errors[*instances[i].group];
    error = std::max(error, models[instances[i].model][choice.level[i]].error * needs.stretch(i));
  }
  return errors;
}

}  // namespace

ViewLevels view_levels(std::span<const TriangleMesh> models, std::span<const ViewInstance> instances,
                       std::span<const ViewCamera> cameras, const ViewOptions& options, const ViewSink& sink) {
  check(options);
  const StopToken stop = StopToken{}.until(StopToken::Clock::now(), checked_seconds(options.lod.time_limit));
  const Needs needs(models, instances, cameras, options.pixels);
  ViewLevels result;
  for (std::size_t model = 0; model < models.size(); ++model) {
    const std::vector<double> ladder = ladder_of(bounding_box_diagonal(models[model]), options);
    const std::set<std::size_t> steps = needed_steps(ladder, model, instances, cameras.size(), needs);
    LodOptions chain_options = options.lod;
    chain_options.time_limit = stop.seconds_left();
    result.models.push_back(make_levels(models[model], model, ladder, steps, chain_options, sink));
    result.levels_computed += steps.size();
    result.levels_skipped += ladder.size() - steps.size();
  }
  for (std::size_t camera = 0; camera < cameras.size(); ++camera) {
    result.cameras.push_back(choose(camera, instances, needs, result.models));
    result.group_errors.push_back(errors_of_groups(result.cameras.back(), instances, needs, result.models));
  }
  return result;
}

}  // namespace meshbound
