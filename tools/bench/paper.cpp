// SPDX-License-Identifier: GPL-3.0-or-later
// paper: the protocol of section 7.1 of Tang, Lee, Kim 2009 on stand-ins of the sizes of its Figure 7. Two models three
// longest dimensions apart, centre to centre; one moves towards the other until their centres meet. Trees are built
// once, before; error bound 1e-4 for models of longest dimension 1. Each step is measured by itself ("cold", the
// protocol of the paper), and once more from what the step before has left ("warm", `MovingPair`).
#include <algorithm>
#include <cstdio>
#include <functional>
#include <limits>

#include "bench_main.h"
#include "datasets/analytic_meshes.h"
#include "measure.h"
#include "meshbound/bvh.h"
#include "meshbound/distance.h"
#include "meshbound/mesh_summary.h"
#include "meshbound/motion.h"
#include "meshbound/pose.h"
#include "meshes.h"
#include "table.h"

namespace {

using namespace meshbound;
using namespace meshbound::bench;

/// A model of the paper: a mesh of the data sets brought to its size by midpoint subdivision and decimation, else a
/// generated one.
struct Model {
  const char* name;
  std::size_t triangles;
  const char* dataset;
  int subdivisions;
  const char* kind;  ///< for `mesh_of_size`
};

/// A pair of its Table 2, with the milliseconds and culling rates it reports.
struct Benchmark {
  Model a, b;
  double average, smallest, largest, culled_on_a, culled_on_b;
};

const Benchmark benchmarks[] = {
    {{"Bird1", 2'200, "organic/c3d_cow.obj", 0, "torus"},
     {"Bird2", 6'200, "organic/c3d_homer.obj", 0, "uv-sphere"},
     2.57,
     0.10,
     6.37,
     99.27,
     99.42},
    {{"Watch1", 3'800, "game/gltf_Duck.obj", 0, "gear"},
     {"Watch2", 38'100, "game/c3d_beetle-alt.obj", 0, "torus"},
     6.92,
     1.50,
     31.31,
     99.93,
     97.60},
    {{"Puma1", 8'200, "organic/igl_arm.obj", 0, "gear"},
     {"Puma2", 7'100, "organic/c3d_cheburashka.obj", 0, "torus"},
     6.10,
     1.63,
     21.28,
     99.18,
     98.43},
    {{"Bunny1", 16'700, "scan/c3d_stanford-bunny.obj", 0, "uv-sphere"},
     {"Bunny2", 69'700, "scan/c3d_stanford-bunny.obj", 0, "uv-sphere"},
     21.95,
     0.18,
     948.40,
     97.12,
     99.77},
    {{"Fish1", 11'000, "organic/igl_elephant.obj", 0, "torus"},
     {"Fish2", 36'500, "scan/igl_face.obj", 0, "terrain"},
     18.77,
     1.24,
     69.22,
     99.59,
     99.60},
    {{"Dog", 3'200, "organic/igl_cow.off", 0, "torus"},
     {"Lion", 1'300'000, "scan/igl_armadillo.obj", 2, "torus"},
     84.31,
     0.04,
     670.60,
     98.03,
     99.99},
};

/// Centred at the origin, longest dimension 1.
TriangleMesh centred(TriangleMesh mesh) {
  const Eigen::AlignedBox3d box = used_bounding_box(mesh);
  for (Eigen::Vector3d& p : mesh.vertices) p = (p - box.center()) / box.sizes().maxCoeff();
  return mesh;
}

TriangleMesh stand_in(const Model& model, const Options& options) {
  const auto file = find_dataset({model.dataset});
  if (!file) {
    std::fprintf(stderr, "paper: %s is missing, taking a %s for %s\n", model.dataset, model.kind, model.name);
    return centred(datasets::mesh_of_size(model.kind, model.triangles));
  }
  Recipe recipe{*file};
  recipe.subdivisions = model.subdivisions;
  TriangleMesh mesh = make(recipe, options.cache);
  const double ratio = static_cast<double>(model.triangles) / static_cast<double>(mesh.triangles.size());
  if (ratio < 0.95) {
    recipe.ratio = ratio;
    mesh = make(recipe, options.cache);
  }
  return centred(std::move(mesh));
}

/// Milliseconds and counts of one step.
struct Step {
  double separation = 0, milliseconds = 0, distance = 0;
  double culled_on_a = 0, culled_on_b = 0, queries = 0, nodes = 0, tests = 0, walked = 0, subdivisions = 0;
};

/// Measures the distance at a pose of B.
using Measure = std::function<HausdorffDistance(const Pose& pose, const DistanceOptions& options)>;

/// Both directions together: each rate is the mean of the two.
Step measure_step(const Measure& measure, double separation) {
  Pose pose = Pose::Identity();
  pose.translation().x() = separation;
  DistanceOptions options;
  options.threads = 1;
  options.error_bound = 1e-4;
  const Stopwatch watch;
  const HausdorffDistance distance = measure(pose, options);
  Step step{separation, 1000 * watch.elapsed().cpu, distance.bounds.upper};
  for (const OneSidedDistance* side : {&distance.a_to_b, &distance.b_to_a}) {
    const DistanceStats& stats = side->stats;
    step.culled_on_a += stats.culled_on_a_percent / 2;
    step.culled_on_b += stats.culled_on_b_percent / 2;
    step.queries += static_cast<double>(stats.closest_point_queries);
    step.nodes += static_cast<double>(stats.nodes_visited);
    step.tests += static_cast<double>(stats.triangles_tested);
    step.walked += static_cast<double>(stats.walked);
    step.subdivisions += static_cast<double>(stats.subdivisions);
  }
  return step;
}

std::vector<Step> approach(const Measure& measure, int steps) {
  std::vector<Step> all;
  for (int i = 0; i <= steps; ++i) all.push_back(measure_step(measure, 3 * (1 - static_cast<double>(i) / steps)));
  return all;
}

std::vector<Step> approach_cold(const Bvh& a, const Bvh& b, int steps) {
  return approach(
      [&](const Pose& pose, const DistanceOptions& options) {
        return hausdorff_distance(a, {b, pose}, options);
      },
      steps);
}

std::vector<Step> approach_warm(const Bvh& a, const Bvh& b, int steps) {
  MovingPair pair(a, b);
  return approach(
      [&](const Pose& pose, const DistanceOptions& options) {
        return pair.hausdorff_distance(Pose::Identity(), pose, options);
      },
      steps);
}

double average(const std::vector<Step>& steps, double Step::*field) {
  double sum = 0;
  for (const Step& step : steps) sum += step.*field;
  return sum / static_cast<double>(steps.size());
}

void write_steps(const Options& options, const std::string& name, const std::vector<Step>& steps) {
  Table table{{"separation [longest dimensions]", "ms", "upper [longest dimensions]", "culled on A %", "culled on B %",
               "queries", "nodes visited", "triangles tested", "triangles walked", "subdivisions"},
              {}};
  for (const Step& s : steps)
    table.rows.push_back({format(s.separation, 6), format(s.milliseconds, 6), format(s.distance, 9),
                          format(s.culled_on_a, 6), format(s.culled_on_b, 6), format(s.queries, 9), format(s.nodes, 9),
                          format(s.tests, 9), format(s.walked, 9), format(s.subdivisions, 9)});
  table.write_csv(options.out / ("paper-" + name + ".csv"), options.machine);
}

int run(const Options& options) {
  Table table{{"pair",   "triangles",    "average ms",      "paper's",     "ratio (target 10)", "min ms",    "paper's",
               "max ms", "paper's",      "culled on A %",   "paper's",     "culled on B %",     "paper's",   "queries",
               "nodes",  "subdivisions", "warm average ms", "warm max ms", "warm queries",      "warm nodes"},
              {}};
  for (const Benchmark& benchmark : benchmarks) {
    const std::string name = std::string(benchmark.a.name) + '-' + benchmark.b.name;
    if (!options.wants(name)) continue;
    const TriangleMesh mesh_a = stand_in(benchmark.a, options), mesh_b = stand_in(benchmark.b, options);
    const Bvh a(mesh_a, {1}), b(mesh_b, {1});
    const int count = options.quick ? 60 : 350;
    const std::vector<Step> steps = approach_cold(a, b, count), warm = approach_warm(a, b, count);
    const auto faster = [](const Step& x, const Step& y) { return x.milliseconds < y.milliseconds; };
    const auto [low, high] = std::minmax_element(steps.begin(), steps.end(), faster);
    const auto warm_high = std::max_element(warm.begin(), warm.end(), faster);
    const double ms = average(steps, &Step::milliseconds);
    write_steps(options, name, steps);
    write_steps(options, name + "-warm", warm);
    table.rows.push_back({name,
                          std::to_string(mesh_a.triangles.size()) + " / " + std::to_string(mesh_b.triangles.size()),
                          format(ms),
                          format(benchmark.average),
                          format(benchmark.average / ms),
                          format(low->milliseconds),
                          format(benchmark.smallest),
                          format(high->milliseconds),
                          format(benchmark.largest),
                          format(average(steps, &Step::culled_on_a), 4),
                          format(benchmark.culled_on_a, 4),
                          format(average(steps, &Step::culled_on_b), 4),
                          format(benchmark.culled_on_b, 4),
                          format(average(steps, &Step::queries)),
                          format(average(steps, &Step::nodes)),
                          format(average(steps, &Step::subdivisions)),
                          format(average(warm, &Step::milliseconds)),
                          format(warm_high->milliseconds),
                          format(average(warm, &Step::queries)),
                          format(average(warm, &Step::nodes))});
    table.write_csv(options.out / "paper.csv", options.machine);
    std::printf("%s\n", Table{table.columns, {table.rows.back()}}.markdown().c_str());
    std::fflush(stdout);
  }
  if (!options.found_any()) return 0;
  write_file(options.out / "paper.md", table.markdown());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return bench_main(argc, argv, "The protocol of the paper's Table 2: one model moves towards the other.", run);
}
