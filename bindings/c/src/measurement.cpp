// SPDX-License-Identifier: MIT
#include "measurement.h"

#include <cmath>
#include <limits>
#include <utility>

#include "arguments.h"
#include "guard.h"
#include "meshbound/mesh_summary.h"
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

HausdorffDistance measure(const MeshView& a, const MeshView& b, const DistanceOptions& options, bool one_sided) {
  return one_sided ? only_a_to_b(one_sided_hausdorff_distance(a, b, options)) : hausdorff_distance(a, b, options);
}

ToleranceCheck check(const MeshView& a, const MeshView& b, double tolerance, const DistanceOptions& options,
                     bool one_sided) {
  return one_sided ? check_one_sided_tolerance(a, b, tolerance, options) : check_tolerance(a, b, tolerance, options);
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
