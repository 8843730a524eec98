// SPDX-License-Identifier: GPL-3.0-or-later
// random_pairs: 30 random pairs of at most 1,300 triangles, ours against CGAL's bounded-error distance: the function of
// the library, and a whole process that reads two files. The number of pairs on which ours is slower should be 0.
#include <cmath>
#include <cstdio>

#include "bench_main.h"
#include "case_meshes.h"
#include "cgal_functions.h"
#include "meshbound/distance.h"
#include "meshbound/io.h"
#include "meshbound/mesh_summary.h"
#include "our_run.h"
#include "process_run.h"
#include "table.h"

namespace {

using namespace meshbound;
using namespace meshbound::bench;

constexpr std::uint32_t pairs = 30;
constexpr double error_bound = 1e-6;  // model units; the first mesh has a diagonal of about 1
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Median of the processor seconds of one call, in a child process; not a number when it takes longer than `limit`.
double seconds_of_calls(double limit, std::size_t calls, const std::function<void()>& function) {
  const ChildResult child = run_in_child(limit, [&] {
    std::vector<double> seconds;
    double used = 0;
    constexpr double enough = 0.5;
    while (seconds.size() < calls && used < enough) {
      const Stopwatch watch;
      function();
      seconds.push_back(watch.elapsed().cpu);
      used += seconds.back();
    }
    return std::vector<double>{median(seconds)};
  });
  return child.status == ChildResult::Status::Done ? child.values[0] : nan;
}

struct Compared {
  double ours = nan, cgal = nan;
  /// A time that is not a number took longer than the limit.
  [[nodiscard]] bool is_slower() const { return std::isnan(ours) || ours > cgal; }
};

/// Median of interleaved turns: `one_turn` says how long a contestant took.
template <class Ours, class Cgal>
Compared compare(std::size_t rounds, const Ours& ours, const Cgal& cgal) {
  std::vector<double> seconds[2];
  const auto turn = [&](int of, double took) {
    if (std::isnan(took)) return -1.0;
    seconds[of].push_back(took);
    return took;
  };
  interleave({[&] { return turn(0, ours()); }, [&] { return turn(1, cgal()); }}, rounds, 2.0);
  return {seconds[0].empty() ? nan : median(seconds[0]), seconds[1].empty() ? nan : median(seconds[1])};
}

Compared compare_functions(const MeshPair& pair, const CgalPair& cgal, double limit) {
  constexpr std::size_t rounds = 3, calls = 15;
  const auto ours = [&] {
    DistanceOptions options;
    options.threads = 1;
    options.error_bound = error_bound;
    (void)hausdorff_distance(pair.a, pair.b, options);
  };
  return compare(
      rounds, [&] { return seconds_of_calls(limit, calls, ours); },
      [&] { return seconds_of_calls(limit, calls, [&] { (void)cgal.bounded_error(error_bound); }); });
}

Compared compare_processes(const MeshPair& pair, const std::filesystem::path& folder, double limit) {
  constexpr std::size_t rounds = 15;
  const std::filesystem::path a = folder / "random_a.off", b = folder / "random_b.off", output = folder / "random.txt";
  write_mesh(a, pair.a);
  write_mesh(b, pair.b);
  const std::string bound = format(error_bound);
  const auto seconds = [&](const std::vector<std::string>& arguments) {
    const ProcessRun run = run_process(arguments, output, limit);
    if (!run.in_time) return nan;
    if (run.exit_code != 0) throw std::runtime_error(arguments[0] + " failed on " + a.string() + " and " + b.string());
    return run.cpu_seconds;
  };
  return compare(
      rounds,
      [&] {
        return seconds({HAUSDORFF_DISTANCE, a, b, "--error-bound", bound, "--threads", "1"});
      },
      [&] {
        return seconds({CGAL_PROCESS, a, b, bound});
      });
}

int run(const Options& options) {
  Table table{{"pair", "triangles A", "triangles B", "ours ms", "CGAL ms", "ratio", "our process ms", "CGAL process ms",
               "ratio"},
              {}};
  int slower_functions = 0, slower_processes = 0;
  std::vector<double> ratios[2];
  for (std::uint32_t seed = 1; seed <= pairs; ++seed) {
    const std::string name = "random " + std::to_string(seed);
    if (!options.wants(name)) continue;
    const MeshPair pair = random_pair(seed);
    const auto cgal = CgalPair::make(pair.a, pair.b);
    if (!cgal) throw std::runtime_error(name + ": CGAL does not take the pair");
    const Compared functions = compare_functions(pair, *cgal, options.limit);
    const Compared processes = compare_processes(pair, options.cache, options.limit);
    slower_functions += functions.is_slower() ? 1 : 0;
    slower_processes += processes.is_slower() ? 1 : 0;
    const double ratio = functions.cgal / functions.ours, process_ratio = processes.cgal / processes.ours;
    if (!std::isnan(ratio)) ratios[0].push_back(ratio);
    if (!std::isnan(process_ratio)) ratios[1].push_back(process_ratio);
    table.rows.push_back({name, std::to_string(pair.a.triangles.size()), std::to_string(pair.b.triangles.size()),
                          format(1e3 * functions.ours), format(1e3 * functions.cgal), format(ratio),
                          format(1e3 * processes.ours), format(1e3 * processes.cgal), format(process_ratio)});
    table.write_csv(options.out / "random_pairs.csv", options.machine);
  }
  if (!options.found_any()) return 0;
  const std::string summary = "Slower than CGAL: " + std::to_string(slower_functions) + " of " +
                              std::to_string(table.rows.size()) + " pairs in the library, " +
                              std::to_string(slower_processes) + " as whole processes (target 0 and 0). " +
                              "Geometric means of CGAL / ours: " + format(geometric_mean(ratios[0])) + " and " +
                              format(geometric_mean(ratios[1])) + ".\n";
  write_file(options.out / "random_pairs.md", summary + '\n' + table.markdown());
  std::printf("%s\n%s", table.markdown().c_str(), summary.c_str());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return bench_main(argc, argv, "Random pairs of small meshes, ours against CGAL's.", run);
}
