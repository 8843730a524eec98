// SPDX-License-Identifier: GPL-3.0-or-later
#include "our_run.h"

#include "meshbound/bvh.h"
#include "meshbound/distance.h"

namespace meshbound::bench {
namespace {

Bounds measure(const Bvh& a, const Bvh& b, const OurTask& task) {
  DistanceOptions options;
  options.threads = task.threads;
  options.method = task.method;
  if (task.tolerance >= 0) return check_tolerance(a, b, task.tolerance, options).bounds;
  options.error_bound = task.error_bound;
  if (task.one_sided) return one_sided_hausdorff_distance(a, b, options).bounds;
  return hausdorff_distance(a, b, options).bounds;
}

}  // namespace

OurRun run_ours(const TriangleMesh& a, const TriangleMesh& b, const OurTask& task) {
  const ChildResult child = run_in_child(task.limit, [&] {
    const Stopwatch watch;
    // What `hausdorff_distance` and `check_tolerance` of two meshes do, with the time of building apart.
    const double limit = task.tolerance < 0 ? task.error_bound : task.tolerance;
    if (const auto known = task.one_sided ? std::nullopt : distance_without_trees(a, b, limit)) {
      const Times all = watch.elapsed();
      return std::vector<double>{known->bounds.lower, known->bounds.upper, 0, 0, all.wall, all.cpu};
    }
    const auto [tree_a, tree_b] = build_trees(a, b, {task.threads});
    const Times built = watch.elapsed();
    const Bounds bounds = measure(tree_a, tree_b, task);
    const Times total = watch.elapsed();
    return std::vector<double>{bounds.lower,         bounds.upper, built.wall, built.cpu, total.wall - built.wall,
                               total.cpu - built.cpu};
  });
  OurRun run;
  run.status = child.status;
  run.error = child.error;
  run.peak_bytes = child.peak_bytes;
  if (child.status != ChildResult::Status::Done) return run;
  const std::vector<double>& v = child.values;
  run.bounds = {v[0], v[1]};
  run.build = {v[2], v[3]};
  run.query = {v[4], v[5]};
  return run;
}

}  // namespace meshbound::bench
