// SPDX-License-Identifier: MIT
#include "measurement.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "arguments.h"
#include "guard.h"
#include "meshbound/mesh_summary.h"
#include "meshbound/stop_token.h"
#include "results.h"

namespace meshbound::c_interface {
namespace {

mb_distance_options default_distance_options() {
  mb_distance_options options{};
  options.error_bound = -1;
  options.time_limit = std::numeric_limits<double>::infinity();
  options.tolerance = -1;
  return options;
}

/// A distance with the result of one direction only.
HausdorffDistance only_a_to_b(OneSidedDistance direction) {
  HausdorffDistance distance;
  distance.bounds = direction.bounds;
  distance.a_to_b = std::move(direction);
  return distance;
}

BvhOptions tree_options(const DistanceOptions& options) { return {options.threads, {.cancel = options.cancel}}; }

/// The distance of two meshes if it can be found without trees, as for two copies of one mesh; absent otherwise. Within
/// the error bound, and decided for the tolerance, if any.
std::optional<HausdorffDistance> looked_up(const MeshView& a, const MeshView& b, const DistanceOptions& options) {
  if (a.triangle_count() != b.triangle_count()) return std::nullopt;
  const double tolerance = options.tolerance.value_or(std::numeric_limits<double>::infinity());
  const double error_bound =
      options.error_bound ? *options.error_bound : default_error_bound(a, b, bounding_box_diagonal(a));
  return distance_without_trees(a, b, std::min(error_bound, tolerance));
}

HausdorffDistance measure(const MeshView& a, const MeshView& b, const DistanceOptions& options, bool one_sided) {
  if (const auto known = looked_up(a, b, options)) return one_sided ? only_a_to_b(known->a_to_b) : *known;
  const auto [tree_a, tree_b] = build_trees(a, b, tree_options(options));
  if (one_sided) return only_a_to_b(one_sided_hausdorff_distance(tree_a, tree_b, options));
  return hausdorff_distance(tree_a, tree_b, options);
}

/// The decision on a distance whose upper bound is at most the tolerance; of the one-sided distance, which then is too,
/// the bounds of that direction alone.
ToleranceCheck within(double tolerance, const HausdorffDistance& known, bool one_sided) {
  const HausdorffDistance decided = one_sided ? only_a_to_b(known.a_to_b) : known;
  return {Verdict::Within, tolerance, decided.bounds, decided.a_to_b, decided.b_to_a};
}

ToleranceCheck check(const MeshView& a, const MeshView& b, double tolerance, const DistanceOptions& options,
                     bool one_sided) {
  if (!(tolerance >= 0)) throw InvalidInput("the tolerance must be a length of 0 or more");
  if (const auto known = distance_without_trees(a, b, tolerance)) return within(tolerance, *known, one_sided);
  const auto [tree_a, tree_b] = build_trees(a, b, tree_options(options));
  return one_sided ? check_one_sided_tolerance(tree_a, tree_b, tolerance, options)
                   : check_tolerance(tree_a, tree_b, tolerance, options);
}

}  // namespace

DistanceOptions library_options(const mb_distance_options& options, RunControl& control) {
  DistanceOptions result;
  if (std::isnan(options.error_bound)) throw InvalidInput("error_bound is not a number");
  if (options.error_bound >= 0) result.error_bound = options.error_bound;
  if (std::isnan(options.tolerance)) throw InvalidInput("tolerance is not a number");
  if (options.tolerance >= 0) result.tolerance = options.tolerance;
  if (!(options.time_limit >= 0)) throw InvalidInput("time_limit must be 0 seconds or more");
  result.budget.seconds = options.time_limit;
  result.threads = options.threads;
  result.cancel = control.flag();
  result.progress = control.progress();
  return result;
}

}  // namespace meshbound::c_interface

using namespace meshbound;
using namespace meshbound::c_interface;

mb_status mb_distance_options_init(mb_distance_options* options, size_t size) {
  return guarded([&] {
    require(options, "options");
    initialise(options, size, default_distance_options());
  });
}

mb_status mb_describe(const mb_mesh* mesh, mb_mesh_facts* facts) {
  return guarded([&] {
    require(facts, "facts");
    const MeshSummary summary = summarise(valid_view_of(mesh, "mesh"));
    *facts = {summary.vertices, summary.faces, summary.components, summary.bbox_diagonal, summary.closed ? 1 : 0};
  });
}

mb_status mb_measure(const mb_mesh* a, const mb_mesh* b, const mb_distance_options* options, mb_distance* distance) {
  return guarded(threads_of(options), [&] {
    require(distance, "distance");
    const mb_distance_options given = complete(options, mb_distance_options_init);
    RunControl control(given);
    const DistanceOptions wanted = library_options(given, control);
    const HausdorffDistance result =
        measure(valid_view_of(a, "a"), valid_view_of(b, "b"), wanted, given.one_sided != 0);
    control.finish();
    *distance = to_c(result);
  });
}

mb_status mb_check(const mb_mesh* a, const mb_mesh* b, double tolerance, const mb_distance_options* options,
                   mb_verdict* verdict, mb_distance* distance) {
  return guarded(threads_of(options), [&] {
    require(verdict, "verdict");
    const mb_distance_options given = complete(options, mb_distance_options_init);
    RunControl control(given);
    const DistanceOptions wanted = library_options(given, control);
    const ToleranceCheck result =
        check(valid_view_of(a, "a"), valid_view_of(b, "b"), tolerance, wanted, given.one_sided != 0);
    control.finish();
    *verdict = to_c(result.verdict);
    if (distance != nullptr) *distance = to_c(result);
  });
}
