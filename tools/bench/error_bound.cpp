// SPDX-License-Identifier: GPL-3.0-or-later
// error_bound: Fig. 10 of Tang, Lee, Kim 2009, processor time against the error bound: ours, their own method (cross-
// culling, in our code), and CGAL's bounded function; for CGAL's sampling against the error it makes.
#include <cmath>
#include <cstdio>

#include "bench_main.h"
#include "cgal_functions.h"
#include "meshes.h"
#include "our_run.h"
#include "pair_list.h"
#include "table.h"

namespace {

using namespace meshbound;
using namespace meshbound::bench;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

struct Subject {
  std::string name;
  TriangleMesh a, b;
};

class Curves {
 public:
  Curves(const Options& options, Table& table) : options_(options), table_(table) {}

  void add(const Subject& subject) {
    if (!options_.wants(subject.name)) return;
    const auto cgal = CgalPair::make(subject.a, subject.b);
    bool cgal_in_time = cgal.has_value(), paper_in_time = true;
    double middle = 0;  // of our tightest interval
    for (int exponent = -2; exponent >= -9; --exponent) {
      const double bound = std::pow(10.0, exponent);
      const OurRun ours = our_run(subject, "ours", bound, Method::CellWalking);
      if (ours.status == ChildResult::Status::Done) middle = (ours.bounds.lower + ours.bounds.upper) / 2;
      // A smaller bound never takes the others less time.
      if (paper_in_time)
        paper_in_time =
            our_run(subject, "cross-culling", bound, Method::CrossCulling).status == ChildResult::Status::Done;
      if (cgal_in_time)
        cgal_in_time = cgal_run(subject, "CGAL bounded", bound, [&] { return cgal->bounded_error(bound); });
    }
    if (cgal) sampled(subject, *cgal, middle);
  }

 private:
  OurRun our_run(const Subject& subject, const char* name, double bound, Method method) {
    OurTask task;
    task.error_bound = bound;
    task.limit = options_.limit;
    task.method = method;
    const OurRun run = run_ours(subject.a, subject.b, task);
    if (run.status == ChildResult::Status::Done)
      row(subject, name, bound, run.build.cpu + run.query.cpu, nan, run.bounds);
    return run;
  }

  void sampled(const Subject& subject, const CgalPair& cgal, double truth) {
    for (const double density : {1e2, 1e3, 1e4, 1e5, 1e6, 1e7}) {
      const ChildResult child = timed([&] { return cgal.approximate(density); });
      if (child.status != ChildResult::Status::Done) return;
      const double error = std::abs(child.values[0] - truth);
      row(subject, "CGAL sampled", std::max(error, 1e-9), child.values[1], child.values[0], {nan, nan});
    }
  }

  bool cgal_run(const Subject& subject, const char* method, double bound, const std::function<double()>& function) {
    const ChildResult child = timed(function);
    if (child.status != ChildResult::Status::Done) return false;
    const double value = child.values[0];  // the distance is within the bound of it
    row(subject, method, bound, child.values[1], value, {std::max(0.0, value - bound), value + bound});
    return true;
  }

  ChildResult timed(const std::function<double()>& function) const {
    return run_in_child(options_.limit, [&] {
      const Stopwatch watch;
      const double value = function();
      return std::vector<double>{value, watch.elapsed().cpu};
    });
  }

  void row(const Subject& subject, const char* method, double bound, double seconds, double value,
           const Bounds& bounds) {
    table_.rows.push_back({subject.name, method, format(bound), format(seconds), format(value, 9),
                           format(bounds.lower, 9), format(bounds.upper, 9)});
    table_.write_csv(options_.out / "error_bound.csv", options_.machine);
    std::printf("%s, %s: %.0e %.3g s\n", subject.name.c_str(), method, bound, seconds);
    std::fflush(stdout);
  }

  const Options& options_;
  Table& table_;
};

/// Bunny and fandisk beside what is made of them.
void add_default_subjects(const Options& options, Curves& curves) {
  const auto fandisk = find_dataset({"cad/c3d_fandisk.obj", "cgal/fandisk.off"});
  const auto bunny = find_dataset({"scan/c3d_stanford-bunny.obj", "cgal/bunny00.off"});
  if (!fandisk || !bunny)
    throw std::runtime_error("fandisk or bunny is missing; run datasets/fetch or set MESHBOUND_DATASETS");
  const auto decimation = [&](const std::filesystem::path& file) {
    Recipe half{file};
    half.ratio = 0.5;
    return make(half, options.cache);
  };
  curves.add({"bunny / its 50%", make({*bunny}, options.cache), decimation(*bunny)});
  curves.add({"fandisk / its 50%", make({*fandisk}, options.cache), decimation(*fandisk)});
  Recipe finer{*bunny};
  finer.subdivisions = 1;
  curves.add({"bunny / its subdivision", make({*bunny}, options.cache), make(finer, options.cache)});
}

int run(const Options& options) {
  Table table{{"pair", "method", "error bound [diagonals]", "CPU time [s]", "value [diagonals]", "lower [diagonals]",
               "upper [diagonals]"},
              {}};
  Curves curves(options, table);
  for (std::size_t i = 0; i + 1 < options.pair.size(); i += 2) {
    const PairSpec pair = file_pair(options.pair[i], options.pair[i + 1]);
    curves.add({pair.name, make(pair.a, options.cache), make(pair.b, options.cache)});
  }
  if (options.pair.empty()) add_default_subjects(options, curves);
  if (!options.found_any()) return 0;
  write_file(options.out / "error_bound.md", table.markdown());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return bench_main(argc, argv, "Processor time against error bound, 1e-2 to 1e-9 of the diagonal.", run);
}
