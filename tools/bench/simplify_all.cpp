// SPDX-License-Identifier: GPL-3.0-or-later
// simplify_all: time and faces of `simplify_with_bound` over all shared meshes, library to library beside CGAL's
// decimation without a bound to the same number of faces; then what threads, levels, targets, degenerate triangles and
// memory cost. Every result is measured again by us and by CGAL; exit code 1 when one does not hold.
#include <CLI/CLI.hpp>

#include "simplifiers.h"
#include "simplify_parts.h"

namespace {

using namespace meshbound::bench;

constexpr void (*parts[])(const SimplifyBench&) = {all_meshes, named,  blade,      threads,
                                                   levels,     target, degenerate, scale};

}  // namespace

int main(int argc, char** argv) {
  std::vector<double> percents = {1, 0.1, 0.02};
  return bench_main(
      argc, argv, "simplify_with_bound over all shared meshes beside CGAL's decimation.",
      [&](const Options& options) {
        Report report(options, "simplify_all");
        for (const auto part : parts) part({options, percents, report});
        return report.finish();
      },
      [&](CLI::App& app) {
        app.add_option("--percent", percents, "tolerances of all-meshes in percent of the diagonal")
            ->capture_default_str();
        app.add_option_function<std::string>("--driver", choose_driver, "who makes the collapses: cgal or core")
            ->check(CLI::IsMember({"cgal", "core"}));
      });
}
