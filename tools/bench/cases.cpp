// SPDX-License-Identifier: GPL-3.0-or-later
// cases: small inputs on which the engine or the simplifier was once slow out of all proportion, each beside the figure
// it had then and the one it should reach. Every case runs in a process of its own that ends at the limit. Exit code 1
// when a result is not decided or an interval is wider than asked; a figure that is not reached is only shown.
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <stdexcept>

#include "bench_main.h"
#include "case_meshes.h"
#include "child_process.h"
#include "datasets/analytic_meshes.h"
#include "measure.h"
#include "meshbound/cgal/simplify_with_bound.h"
#include "meshbound/distance.h"
#include "meshbound/io.h"
#include "meshbound/mesh_summary.h"
#include "meshes.h"
#include "process_run.h"
#include "table.h"

namespace {

using namespace meshbound;
using namespace meshbound::bench;

enum class Unit { Seconds, Milliseconds, NanosecondsATriangle, MillionsASecond };

const char* to_string(Unit unit) {
  switch (unit) {
    case Unit::Seconds:
      return " s";
    case Unit::Milliseconds:
      return " ms";
    case Unit::NanosecondsATriangle:
      return " ns a triangle";
    case Unit::MillionsASecond:
      break;
  }
  return " M/s";
}

/// `measure` runs in a child process and returns the figure; it throws when the result is not what was asked for.
struct Case {
  std::string name;
  std::string old_figure;
  double reach = 0;
  Unit unit = Unit::Seconds;
  std::function<double()> measure;
  [[nodiscard]] bool is_reached(double figure) const {
    return unit == Unit::MillionsASecond ? figure >= reach : figure <= reach;
  }
};

enum class Sides { One, Both };

/// Processor seconds of one thread for trees and search.
double distance_seconds(const TriangleMesh& a, const TriangleMesh& b, double error_bound, Sides sides = Sides::Both) {
  DistanceOptions options;
  options.threads = 1;
  options.error_bound = error_bound;
  const Stopwatch watch;
  const Bounds bounds = sides == Sides::Both ? hausdorff_distance(a, b, options).bounds
                                             : one_sided_hausdorff_distance(Bvh(a, {1}), Bvh(b, {1}), options).bounds;
  const double seconds = watch.elapsed().cpu;
  if (bounds.upper - bounds.lower > error_bound)
    throw std::runtime_error("the interval [" + format(bounds.lower, 9) + ", " + format(bounds.upper, 9) +
                             "] is wider than asked, after " + format(seconds) + " s");
  return seconds;
}

/// Seconds of simplifying at 0.1% of the diagonal, the measurement of the result included.
double simplify_seconds(const TriangleMesh& mesh) {
  SimplifyOptions options;
  options.tolerance = 0.001 * bounding_box_diagonal(mesh);
  options.threads = 1;
  const Stopwatch watch;
  const SimplifyResult result = cgal::simplify_with_bound(mesh, options);
  const double seconds = watch.elapsed().cpu;
  if (result.last().verdict != Verdict::Within) throw std::runtime_error("the result is undecided");
  return seconds;
}

double build_nanoseconds(const TriangleMesh& mesh) {
  const Stopwatch watch;
  const Bvh tree(mesh, {1});
  return 1e9 * watch.elapsed().cpu / static_cast<double>(tree.triangle_count());
}

/// Cell of the unit cube in a grid of 1024 cells a side, numbered along the Morton curve.
std::uint32_t morton_code(const Eigen::Vector3d& unit_position) {
  std::uint32_t code = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double clamped = std::clamp(unit_position[axis], 0.0, 1.0);
    const auto cell = static_cast<std::uint32_t>(clamped * 1023);
    for (std::uint32_t bit = 0; bit < 10; ++bit)
      code |= ((cell >> bit) & 1U) << (3 * bit + static_cast<std::uint32_t>(axis));
  }
  return code;
}

/// Points 1% of the diagonal beside the middles of the triangles, in Morton order.
std::vector<Eigen::Vector3d> queries_near(const TriangleMesh& mesh) {
  const Eigen::AlignedBox3d box = used_bounding_box(mesh);
  std::vector<std::pair<std::uint32_t, Eigen::Vector3d>> coded;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Eigen::Vector3d &p = mesh.vertices[a], &q = mesh.vertices[b], &r = mesh.vertices[c];
    const Eigen::Vector3d normal = (q - p).cross(r - p).normalized();
    const Eigen::Vector3d at = (p + q + r) / 3 + 0.01 * box.diagonal().norm() * normal;
    coded.emplace_back(morton_code((at - box.min()).cwiseQuotient(box.sizes())), at);
  }
  std::stable_sort(coded.begin(), coded.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Eigen::Vector3d> queries;
  for (const auto& entry : coded) queries.push_back(entry.second);
  return queries;
}

enum class Queries { OneByOne, Batched };

/// In millions. The median of several passes: in the first one, the kernel clears the pages of the answers.
double closest_points_a_second(const TriangleMesh& mesh, Queries how) {
  const Bvh tree(mesh, {1});
  const std::vector<Eigen::Vector3d> queries = queries_near(mesh);
  constexpr int passes = 5;
  std::vector<double> rates;
  for (int pass = 0; pass < passes; ++pass) {
    const Stopwatch watch;
    double sum = 0;
    if (how == Queries::OneByOne)
      for (const Eigen::Vector3d& query : queries) sum += closest_point(tree, query).distance.upper;
    else
      for (const ClosestPoint& closest : closest_points(tree, queries, {1})) sum += closest.distance.upper;
    const double seconds = watch.elapsed().cpu;
    if (!std::isfinite(sum)) throw std::runtime_error("a closest point is not finite");
    rates.push_back(1e-6 * static_cast<double>(queries.size()) / seconds);
  }
  return median(rates);
}

double process_milliseconds(const std::filesystem::path& folder) {
  const std::filesystem::path a = folder / "cube_a.off", b = folder / "cube_b.off";
  write_mesh(a, datasets::cube(1, 1));
  write_mesh(b, datasets::cube(2, 1));
  constexpr double limit = 10;
  const ProcessRun run = run_process({HAUSDORFF_DISTANCE, a, b, "--threads", "1"}, folder / "cubes.txt", limit);
  if (!run.in_time || run.exit_code != 0) throw std::runtime_error("hausdorff_distance failed on two cubes");
  return 1e3 * run.cpu_seconds;
}

/// Two coplanar triangles whose common edge has vertices of its own on either side, and one triangle across it.
MeshPair seam_pair() {
  MeshPair pair;
  pair.a.vertices = {{0, 1, 0}, {1, 1, 0}, {1, 2, 0}};
  pair.a.triangles = {{0, 1, 2}};
  pair.b.vertices = {{0, 0, 0}, {1, 1, 0}, {1, 2, 0}, {0, 0, 0}, {1, 2, 0}, {0, 2, 0}};
  pair.b.triangles = {{0, 1, 2}, {3, 4, 5}};
  return pair;
}

/// thingi_65004 at a diagonal of 1 and its decimation to 144 faces: two of its sheets are equally near.
std::optional<MeshPair> tie_pair(const std::filesystem::path& cache) {
  const auto original = find_dataset({"../cases/thingi_65004.off"});
  const auto reduced = find_dataset({"../cases/thingi_65004_10.off"});
  if (original && reduced) return MeshPair{read_mesh(*reduced).mesh, read_mesh(*original).mesh};
  const auto file = find_dataset({"broken/thingi_65004.stl"});
  if (!file) return std::nullopt;
  Recipe decimation{*file};
  decimation.ratio = 0.1;
  return MeshPair{make(decimation, cache), make({*file}, cache)};
}

TriangleMesh mesh_of_86k() {
  const auto armadillo = find_dataset({"scan/igl_armadillo.obj", "cgal/armadillo.off"});
  return armadillo ? read_mesh(*armadillo).mesh : datasets::mesh_of_size("torus", 86'482);
}

void add_tie_cases(const std::filesystem::path& cache, std::vector<Case>& cases) {
  const std::optional<MeshPair> pair = tie_pair(cache);
  if (!pair) {
    std::fprintf(stderr, "cases: thingi_65004 is missing; set MESHBOUND_DATASETS\n");
    return;
  }
  const std::pair<double, const char*> bounds[] = {{1e-6, "0.04 s"}, {1e-8, "2.2 s"}, {1e-9, "23 s"}};
  for (const auto& [bound, old_figure] : bounds)
    cases.push_back({"thingi_65004 pair one-sided to " + format(bound), old_figure, 0.01, Unit::Seconds,
                     [pair, bound = bound] { return distance_seconds(pair->a, pair->b, bound, Sides::One); }});
}

void add_simplify_cases(std::vector<Case>& cases) {
  const auto add = [&](const char* name, const char* old_figure, double reach, const auto& mesh) {
    cases.push_back({std::string("simplify ") + name + " at 0.1%", old_figure, reach, Unit::Seconds,
                     [mesh] { return simplify_seconds(mesh()); }});
  };
  add("an unwelded flat square of 72", "18 s", 0.02, [] { return unwelded(flat_square(6)); });
  add("an unwelded cube of 432", "> 60 s", 0.02, [] { return unwelded(datasets::cube(1, 6)); });
  add("a fan of 10000", "> 45 s", 0.3, [] { return fan(10'000); });
  add("a cylinder with two caps of 360", "3 to 9 s", 0.05, [] { return capped_cylinder(360); });
  add("a star of 10000", "13 s", 0.3, [] { return star(10'000); });
  add("10000 around an edge", "9 s", 0.3, [] { return around_an_edge(10'000); });
}

/// Error bounds as shares of the first mesh's diagonal.
void add_distance_cases(std::vector<Case>& cases) {
  const auto add = [&](const char* name, const char* old_figure, double reach, double share, const auto& make_pair) {
    cases.push_back({name, old_figure, reach, Unit::Seconds, [share, make_pair] {
                       const MeshPair pair = make_pair();
                       return distance_seconds(pair.a, pair.b, share * bounding_box_diagonal(pair.a));
                     }});
  };
  add("seam pair to 1e-9", "20 min", 0.01, 1e-9, seam_pair);
  const auto one_triangle = [] {
    TriangleMesh mesh;
    mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.triangles = {{0, 1, 2}};
    return mesh;
  };
  add("10000 large triangles / one triangle", "0.01 s", 0.05, 1e-6, [=] {
    return MeshPair{large_random_triangles(10'000), one_triangle()};
  });
  add("one triangle / 10000 large triangles", "21 s", 0.05, 1e-6, [=] {
    return MeshPair{one_triangle(), large_random_triangles(10'000)};
  });
  add("cylinder of 10000 / its axis to 1e-9", "14.5 s", 1, 1e-9, [] {
    return MeshPair{open_cylinder(10'000), chain_on_axis(10'000)};
  });
  add("overlapping coplanar layers of 10000 to 1e-6", "15.7 s", 1, 1e-6, [] {
    return MeshPair{overlapping_layer(10'000, 0, 0), overlapping_layer(10'000, 0.01, 0.1)};
  });
  add("cylinder of 20000 / 1000 stacked needles to 1e-6", "> 12 s", 0.5, 1e-6, [] {
    return MeshPair{open_cylinder(20'000), needle_stack(1000)};
  });
}

void add_small_cases(const std::filesystem::path& cache, std::vector<Case>& cases) {
  cases.push_back({"closest_point near a mesh of 86k in Morton order", "0.27 M/s", 1.5, Unit::MillionsASecond,
                   [] { return closest_points_a_second(mesh_of_86k(), Queries::OneByOne); }});
  cases.push_back({"closest_points near a mesh of 86k in Morton order", "1.1 M/s", 2.5, Unit::MillionsASecond,
                   [] { return closest_points_a_second(mesh_of_86k(), Queries::Batched); }});
  cases.push_back({"build of 70k triangles", "216 ns", 80, Unit::NanosecondsATriangle,
                   [] { return build_nanoseconds(datasets::mesh_of_size("torus", 70'000)); }});
  cases.push_back({"build of 2M triangles", "160 to 240 ns", 80, Unit::NanosecondsATriangle,
                   [] { return build_nanoseconds(datasets::mesh_of_size("torus", 2'000'000)); }});
  cases.push_back({"whole process on two cubes", "3.1 ms", 1.5, Unit::Milliseconds,
                   [cache] { return process_milliseconds(cache); }});
}

struct Measured {
  std::vector<double> figures;
  std::string failure;  ///< why there are none
  bool is_late = false;
};

Measured measure(const Case& what, const Options& options) {
  Measured measured;
  const std::size_t rounds = what.unit == Unit::Milliseconds ? 15 : 3;
  const auto turn = [&] {
    const Stopwatch watch;
    const ChildResult child = run_in_child(options.limit, [&] { return std::vector<double>{what.measure()}; });
    measured.is_late = child.status == ChildResult::Status::TimedOut;
    measured.failure = child.error;
    if (child.status != ChildResult::Status::Done) return -1.0;
    measured.figures.push_back(child.values[0]);
    return watch.elapsed().wall;
  };
  interleave({turn}, rounds, 5.0);
  return measured;
}

int run(const Options& options) {
  std::vector<Case> cases;
  add_distance_cases(cases);
  add_tie_cases(options.cache, cases);
  add_simplify_cases(cases);
  add_small_cases(options.cache, cases);
  Table table{{"case", "was", "reach", "measured", "reached"}, {}};
  bool all_decided = true;
  for (const Case& what : cases) {
    if (!options.wants(what.name)) continue;
    const Measured measured = measure(what, options);
    const bool done = measured.failure.empty() && !measured.is_late;
    all_decided &= measured.failure.empty();
    if (!measured.failure.empty()) std::fprintf(stderr, "cases: %s: %s\n", what.name.c_str(), measured.failure.c_str());
    const double figure = done ? median(measured.figures) : 0;
    table.rows.push_back({what.name, what.old_figure, format(what.reach) + to_string(what.unit),
                          done               ? format(figure) + to_string(what.unit)
                          : measured.is_late ? "> " + format(options.limit) + " s"
                                             : "failed",
                          done && what.is_reached(figure) ? "yes" : "no"});
    table.write_csv(options.out / "cases.csv", options.machine);  // after every row: a long run may be cut short
    std::printf("%s: %s, reached: %s\n", what.name.c_str(), table.rows.back()[3].c_str(), table.rows.back()[4].c_str());
    std::fflush(stdout);
  }
  if (!options.found_any()) return 0;
  write_file(options.out / "cases.md", table.markdown());
  std::printf("%s", table.markdown().c_str());
  return all_decided ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  return bench_main(argc, argv, "Inputs that were once slow, beside the figures to reach.", run);
}
