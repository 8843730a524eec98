// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include "meshbound/io.h"
#include "ratio_summary.h"
#include "simplify_meshes.h"
#include "simplify_parts.h"

namespace meshbound::bench {
namespace {

/// Our run on one thread and CGAL's to the same number of faces, in turn.
struct Pair {
  Turns ours, cgals;
  [[nodiscard]] double ratio() const { return ours.cpu() / cgals.cpu(); }
};

Pair beside_cgal(const Options& options, const TriangleMesh& mesh, const CgalInput& input, double tolerance) {
  Pair pair;
  std::vector<Contender> contenders = {{[&] { return bounded(mesh, within(tolerance)); }, &pair.ours}};
  if (input.mesh)
    contenders.push_back({[&] { return unbounded(*input.mesh, pair.ours.faces()); }, &pair.cgals, &pair.ours});
  contest(options, contenders);
  return pair;
}

}  // namespace

void all_meshes(const SimplifyBench& bench) {
  Report::Section* section = nullptr;
  std::vector<RatioOfMesh> ratios;
  const std::vector<MeshFile> files = meshes_to_simplify();
  for (const double percent : bench.percents) {
    for (const MeshFile& file : files) {
      const std::string name = "all-meshes/" + format(percent) + '/' + file.name;
      if (!bench.options.wants(name)) continue;
      if (section == nullptr)
        section =
            &bench.report.add("all-meshes", "Shared meshes beside CGAL without a bound, one thread",
                              {"mesh", "tolerance %", "triangles", "faces", "ours s", "CGAL s", "ratio", "measuring s",
                               "upper / T", "CGAL's distance / T", "CGAL's input", "CGAL's faces"});
      const TriangleMesh mesh = read_mesh(file.path).mesh;
      const double tolerance = tolerance_of(mesh, percent);
      const CgalInput input = cgal_input(mesh);
      const Pair pair = beside_cgal(bench.options, mesh, input, tolerance);
      const Check checked = pair.ours.done() ? check(bench.options, mesh, pair.ours.mesh, tolerance) : Check{};
      bench.report.must_hold(name, pair.ours, checked);
      if (pair.ours.done() && pair.cgals.done())
        ratios.push_back({file.name, percent, mesh.triangles.size(), pair.ours.faces(), pair.ratio()});
      bench.report.row(
          *section, {file.name, format(percent), std::to_string(mesh.triangles.size()), pair.ours.faces_or_reason(),
                     format(pair.ours.cpu()), format(pair.cgals.cpu()), format(pair.ratio()), format(checked.seconds),
                     format(checked.share, 6), format(checked.cgal_share, 6), input.how, pair.cgals.faces_or_reason()});
      bench.report.summary(*section, ratio_summary(ratios).markdown());
    }
  }
}

}  // namespace meshbound::bench
