// SPDX-License-Identifier: GPL-3.0-or-later
// simplify: faces and time of `simplify_with_bound` beside CGAL's unbounded run to the same number of faces, its
// envelope filter and the bisecting recipe; then faces against tolerance. Every result is measured again by us and by
// CGAL's own function; exit code 1 when one that is to hold does not.
#include <cmath>
#include <cstdio>

#include "bench_main.h"
#include "cgal_functions.h"
#include "child_process.h"
#include "measure.h"
#include "meshbound/io.h"
#include "meshbound/mesh_summary.h"
#include "meshes.h"
#include "simplifiers.h"
#include "table.h"

namespace {

using namespace meshbound;
using namespace meshbound::bench;

struct Case {
  const char* name;
  const char* file;
  double percent;    ///< tolerance, of the diagonal
  int normal, high;  ///< faces to reach
};

constexpr Case cases[] = {{"fandisk", "cad/c3d_fandisk.obj", 0.1, 370, 330},
                          {"rocker-arm", "cad/c3d_rocker-arm.obj", 0.5, 410, 350},
                          {"rocker-arm", "cad/c3d_rocker-arm.obj", 0.1, 2600, 2050},
                          {"bunny", "scan/c3d_stanford-bunny.obj", 0.1, 4150, 3350},
                          {"horse", "scan/c3d_horse.ply", 0.1, 2950, 2400},
                          {"igea", "scan/c3d_igea.ply", 0.1, 3950, 3200},
                          {"igea", "scan/c3d_igea.ply", 0.05, 9300, 7500}};

/// CGAL's result may be off by its error bound.
constexpr double cgal_error = 1e-3;  // tolerances

/// Turns of the programs whose times are compared, and seconds after which one gets no more.
constexpr std::size_t rounds = 5;
constexpr double enough_seconds = 8;

struct Outcome {
  ChildResult::Status status = ChildResult::Status::Failed;
  double faces = 0, share = 0, cgal_share = 0;
  std::vector<double> cpus, walls, certifications;  ///< seconds, by turn
  [[nodiscard]] bool done() const { return status == ChildResult::Status::Done; }
  [[nodiscard]] double cpu() const { return of(cpus); }
  [[nodiscard]] double wall() const { return of(walls); }
  [[nodiscard]] double certify() const { return of(certifications); }
  /// Not a number where no turn came to its end.
  static double of(const std::vector<double>& turns) { return turns.empty() ? NAN : median(turns); }
};

class Cases {
 public:
  explicit Cases(const Options& options) : options_(options) {}

  /// `simplify` in a child process; what it leaves the first time is measured there too, by CGAL where `by_cgal`.
  /// Returns the seconds it took, negative where it came to no end.
  double turn(const TriangleMesh& mesh, double tolerance, bool by_cgal, const std::function<Simplified()>& simplify,
              Outcome& into) {
    const bool first = into.cpus.empty();
    const ChildResult child = run_in_child(options_.limit, [&] {
      const Simplified s = simplify();
      std::vector<double> values = {s.cpu, s.wall, s.certify_cpu};
      if (!first) return values;
      const double share = share_of_tolerance(mesh, s.mesh, tolerance);
      double cgal_share = 0;
      if (const auto pair = by_cgal ? CgalPair::make(mesh, s.mesh) : std::nullopt)
        cgal_share = pair->bounded_error(cgal_error * tolerance) / tolerance;
      values.insert(values.end(), {static_cast<double>(s.mesh.triangles.size()), share, cgal_share});
      return values;
    });
    into.status = child.status;
    if (!into.done()) return -1;
    const auto& v = child.values;
    into.cpus.push_back(v[0]);
    into.walls.push_back(v[1]);
    into.certifications.push_back(v[2]);
    if (first) into.faces = v[3], into.share = v[4], into.cgal_share = v[5];
    return into.cpus.back();
  }

  Outcome run(const TriangleMesh& mesh, double tolerance, bool by_cgal, const std::function<Simplified()>& simplify) {
    Outcome outcome;
    turn(mesh, tolerance, by_cgal, simplify, outcome);
    return outcome;
  }

  /// A result of ours, or of the bisection, must hold.
  void must_hold(const Outcome& outcome) {
    if (outcome.done() && (outcome.share > 1 || outcome.cgal_share > 1 + cgal_error)) all_hold_ = false;
  }
  Outcome run_to_hold(const TriangleMesh& mesh, double tolerance, const std::function<Simplified()>& simplify) {
    const Outcome outcome = run(mesh, tolerance, true, simplify);
    must_hold(outcome);
    return outcome;
  }

  void row(const Case& c, const TriangleMesh& mesh) {
    const double tolerance = 0.01 * c.percent * used_bounding_box(mesh).diagonal().norm();
    Outcome normal, two, free;
    const auto ours = [&](int threads, Outcome& into) {
      return turn(
          mesh, tolerance, true, [&] { return bounded(mesh, tolerance, cgal::Effort::Normal, threads); }, into);
    };
    interleave({[&] { return ours(1, normal); }, [&] { return ours(2, two); },
                [&] {
                  const auto faces = static_cast<std::size_t>(normal.faces);
                  return turn(
                      mesh, tolerance, false, [&] { return unbounded(mesh, faces); }, free);
                }},
               rounds, enough_seconds);
    must_hold(normal);
    must_hold(two);
    Outcome high, envelope, bisection;
    if (!options_.quick) {
      high = run_to_hold(mesh, tolerance, [&] { return bounded(mesh, tolerance, cgal::Effort::High, 1); });
      envelope = run(mesh, tolerance, false, [&] { return in_envelope(mesh, tolerance); });
      bisection = run_to_hold(mesh, tolerance, [&] { return by_bisection(mesh, tolerance); });
    }
    if (normal.done() && free.done()) {
      ratios_.push_back(normal.cpu() / free.cpu());
      ratios_of_two_.push_back(two.wall() / free.wall());
      certify_.push_back(normal.certify() / normal.cpu());
    }
    const auto count = [](const Outcome& o) { return o.done() ? format(o.faces, 6) : std::string("-"); };
    const auto seconds = [](const Outcome& o) { return o.done() ? format(o.cpu()) : std::string("-"); };
    table_.rows.push_back({c.name,
                           format(c.percent),
                           format(double(mesh.triangles.size()), 7),
                           count(normal),
                           std::to_string(c.normal),
                           count(high),
                           std::to_string(c.high),
                           seconds(normal),
                           seconds(free),
                           format(normal.cpu() / free.cpu()),
                           format(two.wall() / free.wall()),
                           seconds(high),
                           format(normal.share, 6),
                           format(normal.cgal_share, 6),
                           count(bisection),
                           seconds(bisection),
                           count(envelope),
                           seconds(envelope),
                           envelope.done() ? format(envelope.share) : "-",
                           format(free.share)});
    print_last();
  }

  int finish() {
    table_.write_csv(options_.out / "simplify.csv", options_.machine);
    write_file(options_.out / "simplify.md", table_.markdown());
    std::printf(
        "normal / CGAL unbounded, geometric means: %s in CPU time on one thread (target 2), %s of the clock on "
        "two (target 1.3); certification: %s of the time (target 0.2)\n",
        format(geometric_mean(ratios_)).c_str(), format(geometric_mean(ratios_of_two_)).c_str(),
        format(geometric_mean(certify_)).c_str());
    if (!all_hold_) std::printf("A RESULT DOES NOT HOLD ITS TOLERANCE\n");
    return all_hold_ ? 0 : 1;
  }

  void curve(const char* name, const TriangleMesh& mesh, Table& curves) {
    const double diagonal = used_bounding_box(mesh).diagonal().norm();
    for (const double percent : {2.0, 1.0, 0.5, 0.2, 0.1, 0.05, 0.02}) {
      const double tolerance = 0.01 * percent * diagonal;
      const auto add = [&](const char* method, const std::function<Simplified()>& simplify) {
        const Outcome o = run_to_hold(mesh, tolerance, simplify);
        if (o.done()) curves.rows.push_back({name, method, format(percent), format(o.faces, 7), format(o.cpu())});
      };
      add("normal", [&] { return bounded(mesh, tolerance, cgal::Effort::Normal, 1); });
      add("bisecting the count", [&] { return by_bisection(mesh, tolerance); });
    }
    curves.write_csv(options_.out / "simplify_curve.csv", options_.machine);
  }

 private:
  void print_last() const {
    for (std::size_t i = 0; i < table_.columns.size(); ++i)
      std::printf("%s%s %s", i == 0 ? "" : ", ", table_.columns[i].c_str(), table_.rows.back()[i].c_str());
    std::printf("\n");
    std::fflush(stdout);
  }

  const Options& options_;
  Table table_{{"mesh",
                "tolerance %",
                "faces",
                "normal",
                "target",
                "high",
                "target high",
                "normal s",
                "CGAL unbounded s",
                "ratio 1 thread",
                "ratio 2 threads",
                "high s",
                "upper / tolerance",
                "CGAL's distance / tolerance",
                "bisecting",
                "bisecting s",
                "envelope",
                "envelope s",
                "envelope: distance / tolerance",
                "unbounded: distance / tolerance"},
               {}};
  std::vector<double> ratios_, ratios_of_two_, certify_;
  bool all_hold_ = true;
};

int run(const Options& options) {
  Cases all(options);
  for (const Case& c : cases) {
    const auto file = find_dataset({c.file});
    if (!file) std::fprintf(stderr, "no %s: set MESHBOUND_DATASETS\n", c.file);
    if (file && options.wants(c.name)) all.row(c, read_mesh(*file).mesh);
  }
  Table curves{{"mesh", "method", "tolerance %", "faces", "CPU seconds"}, {}};
  for (const Case& c : {cases[0], cases[3]}) {
    const auto file = find_dataset({c.file});
    if (!options.quick && file && options.wants(c.name)) all.curve(c.name, read_mesh(*file).mesh, curves);
  }
  return options.found_any() ? all.finish() : 0;
}

}  // namespace

int main(int argc, char** argv) {
  return bench_main(argc, argv, "Faces and time of simplify_with_bound beside what CGAL offers.", run);
}
