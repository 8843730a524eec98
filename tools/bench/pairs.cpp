// SPDX-License-Identifier: GPL-3.0-or-later
// pairs: our symmetric distance against CGAL's on chosen pairs and, without --quick, on every real pair of the data
// sets, or on the pair of --pair A B. Exit code 1 when a result of CGAL's contradicts our interval.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include "bench_main.h"
#include "cgal_functions.h"
#include "our_run.h"
#include "pair_list.h"
#include "table.h"

namespace {

using namespace meshbound;
using namespace meshbound::bench;

constexpr double error_bound = 1e-6;  // model units; every pair is scaled to a diagonal of 1
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// What one contestant measured, over its turns.
struct Measured {
  ChildResult::Status status = ChildResult::Status::Done;
  std::string error;
  std::vector<double> cpu, wall, build_cpu;
  double value = nan;
  Bounds bounds;
  [[nodiscard]] bool done() const { return !cpu.empty() && status == ChildResult::Status::Done; }
  [[nodiscard]] double cpu_seconds() const { return done() ? median(cpu) : nan; }
  [[nodiscard]] double wall_seconds() const { return done() ? median(wall) : nan; }
};

struct PairResult {
  std::size_t triangles_a = 0, triangles_b = 0;
  Measured ours, two_threads, bounded, approximate;
  bool manifold = false;
};

double turn_of_ours(const TriangleMesh& a, const TriangleMesh& b, const OurTask& task, Measured& into) {
  const OurRun run = run_ours(a, b, task);
  into.status = run.status;
  into.error = run.error;
  if (run.status != ChildResult::Status::Done) return -1;
  into.bounds = run.bounds;
  into.build_cpu.push_back(run.build.cpu);
  into.cpu.push_back(run.build.cpu + run.query.cpu);
  into.wall.push_back(run.build.wall + run.query.wall);
  return into.cpu.back();
}

double turn_of_cgal(const std::function<double()>& function, double limit, Measured& into) {
  const ChildResult child = run_in_child(limit, [&] {
    const Stopwatch watch;
    const double value = function();
    const Times times = watch.elapsed();
    return std::vector<double>{value, times.cpu, times.wall};
  });
  into.status = child.status;
  into.error = child.error;
  if (child.status != ChildResult::Status::Done) return -1;
  into.value = child.values[0];
  into.cpu.push_back(child.values[1]);
  into.wall.push_back(child.values[2]);
  return into.cpu.back();
}

PairResult measure(const PairSpec& pair, const Options& options) {
  const TriangleMesh a = make(pair.a, options.cache), b = make(pair.b, options.cache);
  PairResult result;
  result.triangles_a = a.triangles.size();
  result.triangles_b = b.triangles.size();
  const auto cgal = CgalPair::make(a, b);
  result.manifold = cgal.has_value();
  std::vector<Contestant> contestants;
  for (const int threads : {1, 2}) {
    const OurTask task{error_bound, pair.tolerance, threads, threads * options.limit};
    contestants.emplace_back(
        [&, task] { return turn_of_ours(a, b, task, task.threads == 1 ? result.ours : result.two_threads); });
  }
  if (cgal) {
    contestants.emplace_back([&] {
      const auto function = [&] {
        return pair.tolerance < 0 ? cgal->bounded_error(error_bound)
                                  : static_cast<double>(cgal->is_larger(pair.tolerance, error_bound));
      };
      return turn_of_cgal(function, options.limit, result.bounded);
    });
    contestants.emplace_back(
        [&] { return turn_of_cgal([&] { return cgal->approximate(); }, options.limit, result.approximate); });
  }
  interleave(contestants, options.quick ? 3 : 5, 1.0);
  return result;
}

/// CGAL's value lies within its own error bound of the distance, so within it of our interval; some room for its
/// rounding, on which it says nothing.
bool contradicts(const PairSpec& pair, const PairResult& result) {
  if (!result.bounded.done() || !result.ours.done()) return false;
  const Bounds& ours = result.ours.bounds;
  const double value = result.bounded.value;
  if (pair.tolerance >= 0)
    return value != 0 ? ours.upper < pair.tolerance - error_bound : ours.lower > pair.tolerance + error_bound;
  constexpr double rounding = 1e-12;
  return value < ours.lower - error_bound - rounding || value > ours.upper + error_bound + rounding;
}

/// Near-zero pairs are a class of their own, wherever they come from.
std::string class_of(const PairSpec& pair, const PairResult& result) {
  if (pair.tolerance >= 0) return "decision";
  if (pair.kind == "identical") return pair.kind;
  const bool near_zero = result.ours.done() && result.ours.bounds.upper <= 2 * error_bound;
  return near_zero ? "near-zero" : pair.kind == "subdivision" ? "near-zero" : pair.kind;
}

/// CGAL's time over ours; the limit stands for a time that exceeds it.
double ratio_of(const PairResult& result, double limit) {
  if (!result.ours.done()) return nan;
  const double cgal = result.bounded.status == ChildResult::Status::TimedOut ? limit : result.bounded.cpu_seconds();
  return cgal / result.ours.cpu_seconds();
}

std::string cgal_status(const PairResult& result) {
  if (!result.manifold) return "not manifold";
  if (result.bounded.status == ChildResult::Status::TimedOut) return "limit";
  return result.bounded.done() ? "done" : "failed";
}

std::vector<std::string> row_of(const PairSpec& pair, const PairResult& r, double limit) {
  const double ours = r.ours.cpu_seconds(), build = r.ours.done() ? median(r.ours.build_cpu) : nan;
  const bool limited = r.bounded.status == ChildResult::Status::TimedOut;
  const double sampled = r.approximate.value;
  const double sampling_error =
      pair.tolerance >= 0 ? nan : std::max({0.0, r.ours.bounds.lower - sampled, sampled - r.ours.bounds.upper});
  return {pair.name,
          class_of(pair, r),
          std::to_string(r.triangles_a),
          std::to_string(r.triangles_b),
          format(r.ours.bounds.lower, 7),
          format(r.ours.bounds.upper, 7),
          format(ours),
          format(build),
          format(ours - build),
          format(r.ours.wall_seconds()),
          format(r.two_threads.wall_seconds()),
          format(r.ours.wall_seconds() / r.two_threads.wall_seconds()),
          cgal_status(r),
          format(limited ? limit : r.bounded.cpu_seconds()),
          format(r.manifold ? ratio_of(r, limit) : nan),
          format(r.bounded.value, 9),
          contradicts(pair, r) ? "no"
          : r.bounded.done()   ? "yes"
                               : "-",
          format(r.approximate.cpu_seconds()),
          format(sampled),
          format(std::isnan(sampled) ? nan : sampling_error),
          format(pair.reach_seconds)};
}

/// Lengths are in diagonals of the first mesh, times in processor seconds of one thread unless said otherwise. Where
/// the status of CGAL is "limit", its time and the ratio are at least those of the table.
Table empty_table() {
  return {{"pair",
           "class",
           "triangles A",
           "triangles B",
           "lower [diagonals]",
           "upper [diagonals]",
           "ours [s]",
           "ours: build [s]",
           "ours: query [s]",
           "ours: clock [s]",
           "ours: clock of 2 threads [s]",
           "ours: speed-up",
           "CGAL bounded: status",
           "CGAL bounded [s]",
           "CGAL bounded / ours",
           "CGAL bounded: value [diagonals]",
           "CGAL bounded: within our interval",
           "CGAL sampled [s]",
           "CGAL sampled: value [diagonals]",
           "CGAL sampled: error [diagonals]",
           "target [s]"},
          {}};
}

/// Ratios by class, and their targets.
std::string summary(const std::map<std::string, std::vector<double>>& ratios, const std::vector<double>& speed_ups) {
  const std::map<std::string, std::string> wanted = {{"decimation", "30"}, {"near-zero", "100"}};
  Table table{{"class", "pairs", "geometric mean of CGAL / ours", "target", "smallest", "target"}, {}};
  for (const auto& [name, values] : ratios) {
    const auto target = wanted.find(name);
    table.rows.push_back({name, std::to_string(values.size()), format(geometric_mean(values)),
                          target == wanted.end() ? "-" : target->second,
                          format(*std::min_element(values.begin(), values.end())), "1.5"});
  }
  std::string text = table.markdown();
  if (!speed_ups.empty())
    text += "\nTwo threads against one on pairs with a mesh above 50k: geometric mean " +
            format(geometric_mean(speed_ups)) + ", smallest " +
            format(*std::min_element(speed_ups.begin(), speed_ups.end())) + " (target 1.7).\n";
  return text;
}

int run(const Options& options) {
  std::vector<PairSpec> specs;
  for (std::size_t i = 0; i + 1 < options.pair.size(); i += 2)
    specs.push_back(file_pair(options.pair[i], options.pair[i + 1]));
  if (specs.empty()) specs = table_pairs();
  if (!options.quick && options.pair.empty())
    for (PairSpec& pair : dataset_pairs()) specs.push_back(std::move(pair));
  Table table = empty_table();
  std::map<std::string, std::vector<double>> ratios;
  std::vector<double> speed_ups;
  bool agree = true;
  for (const PairSpec& pair : specs) {
    if (!options.wants(pair.name)) continue;
    PairResult result;
    try {
      result = measure(pair, options);
    } catch (const std::exception& error) {
      std::fprintf(stderr, "pairs: %s: %s\n", pair.name.c_str(), error.what());
      continue;
    }
    for (const Measured* measured : {&result.ours, &result.two_threads, &result.bounded, &result.approximate})
      if (measured->status == ChildResult::Status::Failed)
        std::fprintf(stderr, "pairs: %s: %s\n", pair.name.c_str(), measured->error.c_str());
    agree &= !contradicts(pair, result);
    const double ratio = ratio_of(result, options.limit);
    if (result.manifold && !std::isnan(ratio)) ratios[class_of(pair, result)].push_back(ratio);
    const bool large = std::max(result.triangles_a, result.triangles_b) > 50'000;
    if (large && result.ours.done() && result.two_threads.done())
      speed_ups.push_back(result.ours.wall_seconds() / result.two_threads.wall_seconds());
    table.rows.push_back(row_of(pair, result, options.limit));
    table.write_csv(options.out / "pairs.csv", options.machine);  // after every row: a long run may be cut short
    std::printf("%s\n", Table{table.columns, {table.rows.back()}}.markdown().c_str());
    std::fflush(stdout);
  }
  if (!options.found_any()) return 0;
  const std::string text = table.markdown() + '\n' + summary(ratios, speed_ups);
  write_file(options.out / "pairs.md", text);
  std::printf("%s", text.c_str());
  if (!agree) std::fprintf(stderr, "pairs: a result of CGAL's lies outside both error bounds of ours; see the table\n");
  return agree ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  return bench_main(argc, argv, "Our symmetric Hausdorff distance against CGAL's, pair by pair.", run);
}
