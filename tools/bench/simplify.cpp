// SPDX-License-Identifier: GPL-3.0-or-later
// simplify: faces and time of `simplify_with_bound` beside the other ways to a bound that CGAL offers, its envelope
// filter and the bisecting recipe; then faces against tolerance. Every result is measured again by us and by CGAL's own
// function; exit code 1 when one that is to hold does not. `simplify_all` has the times beside CGAL without a bound.
#include <cmath>

#include "meshbound/io.h"
#include "meshes.h"
#include "report.h"
#include "simplify_meshes.h"

namespace {

using namespace meshbound;
using namespace meshbound::bench;

struct Case {
  std::string_view mesh;  ///< in `named_meshes`
  double percent;         ///< tolerance, of the diagonal
};

constexpr Case cases[] = {{"fandisk", 0.1}, {"rocker-arm", 0.5}, {"rocker-arm", 0.1}, {"bunny", 0.1},
                          {"horse", 0.1},   {"igea", 0.1},       {"igea", 0.05}};

/// A result and both of its distances over the tolerance.
struct Checked {
  Turns turns;
  Check check;
};

Checked run_and_check(const Options& options, const TriangleMesh& mesh, double tolerance,
                      const std::function<Simplified()>& simplify) {
  Checked result{run_once(options, simplify), {}};
  if (result.turns.done()) result.check = check(options, mesh, result.turns.mesh, tolerance);
  return result;
}

void row(const Options& options, Report& report, Report::Section& section, const Case& c, const TriangleMesh& mesh) {
  const double tolerance = tolerance_of(mesh, c.percent);
  const std::string name = std::string(c.mesh) + " at " + format(c.percent) + '%';
  const Checked ours = run_and_check(options, mesh, tolerance, [&] { return bounded(mesh, within(tolerance)); });
  report.must_hold(name, ours.turns, ours.check);
  Checked envelope, bisection;
  if (!options.quick) {
    envelope = run_and_check(options, mesh, tolerance, [&] { return in_envelope(mesh, tolerance); });
    bisection = run_and_check(options, mesh, tolerance, [&] { return by_bisection(mesh, tolerance); });
    if (bisection.turns.done()) report.must_hold(name + " by bisection", bisection.turns, bisection.check);
  }
  report.row(section, {std::string(c.mesh), format(c.percent), std::to_string(mesh.triangles.size()),
                       ours.turns.faces_or_reason(), format(ours.turns.cpu() + ours.check.seconds),
                       format(ours.check.share, 6), format(ours.check.cgal_share, 6), bisection.turns.faces_or_reason(),
                       format(bisection.turns.cpu()), envelope.turns.faces_or_reason(), format(envelope.turns.cpu()),
                       envelope.turns.done() ? format(envelope.check.share) : "-"});
}

void curve(const Options& options, Report& report, Report::Section& section, const char* name,
           const TriangleMesh& mesh) {
  for (const double percent : {2.0, 1.0, 0.5, 0.2, 0.1, 0.05, 0.02}) {
    const double tolerance = tolerance_of(mesh, percent);
    const auto add = [&](const char* method, const std::function<Simplified()>& simplify) {
      const Checked c = run_and_check(options, mesh, tolerance, simplify);
      report.must_hold(name + (" at " + format(percent)) + "% by " + method, c.turns, c.check);
      if (c.turns.done())
        report.row(section, {name, method, format(percent), c.turns.faces_or_reason(), format(c.turns.cpu())});
    };
    add("normal", [&] { return bounded(mesh, within(tolerance)); });
    add("bisecting the count", [&] { return by_bisection(mesh, tolerance); });
  }
}

/// One of `named_meshes`; absent where its file is not on this machine.
std::optional<TriangleMesh> named_mesh(std::string_view name) {
  for (const NamedMesh& m : named_meshes) {
    if (m.name != name) continue;
    if (const auto path = find_dataset({std::string(m.file)})) return read_mesh(*path).mesh;
    std::fprintf(stderr, "no %s: set MESHBOUND_DATASETS\n", std::string(m.file).c_str());
  }
  return std::nullopt;
}

int run(const Options& options) {
  Report report(options, "simplify");
  Report::Section& table = report.add(
      "recipes", "Ways to a bound",
      {"mesh", "tolerance %", "triangles", "normal", "normal s", "upper / tolerance", "CGAL's distance / tolerance",
       "bisecting", "bisecting s", "envelope", "envelope s", "envelope: distance / tolerance"});
  for (const Case& c : cases) {
    if (!options.wants(c.mesh)) continue;
    if (const auto mesh = named_mesh(c.mesh)) row(options, report, table, c, *mesh);
  }
  if (options.quick) return report.finish();
  Report::Section& curves =
      report.add("curve", "Faces against tolerance", {"mesh", "method", "tolerance %", "faces", "CPU seconds"});
  for (const char* name : {"fandisk", "bunny"}) {
    if (!options.wants(name)) continue;
    if (const auto mesh = named_mesh(name)) curve(options, report, curves, name, *mesh);
  }
  return report.finish();
}

}  // namespace

int main(int argc, char** argv) {
  return bench_main(argc, argv, "Faces and time of simplify_with_bound beside other ways to a bound.", run);
}
