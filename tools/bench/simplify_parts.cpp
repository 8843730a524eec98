// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify_parts.h"

#include <cmath>
#include <functional>
#include <limits>
#include <optional>

#include "datasets/analytic_meshes.h"
#include "measure.h"
#include "meshbound/io.h"
#include "meshes.h"
#include "simplify_meshes.h"

namespace meshbound::bench {
namespace {

constexpr double usual_percent = 0.1;

/// A mesh that is made when its turn comes.
struct Source {
  std::string name;
  std::function<TriangleMesh()> make;
};

Source from_file(std::string name, const std::filesystem::path& path) {
  return {std::move(name), [path] { return read_mesh(path).mesh; }};
}

Source torus(std::size_t triangles) {
  return {"torus " + std::to_string(triangles), [triangles] { return datasets::mesh_of_size("torus", triangles); }};
}

/// Those of the named meshes that are on this machine.
std::vector<Source> named_sources() {
  std::vector<Source> sources;
  for (const NamedMesh& m : named_meshes)
    if (const auto path = find_dataset({std::string(m.file)})) sources.push_back(from_file(m.name, *path));
  return sources;
}

/// A section that appears with its first row.
class Part {
 public:
  Part(const SimplifyBench& bench, std::string name, std::string title, std::vector<std::string> columns)
      : bench_(bench), name_(std::move(name)), title_(std::move(title)), columns_(std::move(columns)) {}

  [[nodiscard]] const Options& options() const { return bench_.options; }
  [[nodiscard]] bool wants(const std::string& mesh) const { return options().wants(name_ + '/' + mesh); }

  /// Measures a result of ours, which must hold.
  Check checked(const std::string& mesh, const TriangleMesh& original, const Turns& turns, double tolerance) {
    const Check check = turns.done() ? bench::check(options(), original, turns.mesh, tolerance) : Check{};
    bench_.report.must_hold(name_ + '/' + mesh, turns, check);
    return check;
  }
  void fail(const std::string& mesh, const std::string& why) { bench_.report.fail(name_ + '/' + mesh + ' ' + why); }

  void row(std::vector<std::string> cells) { bench_.report.row(section(), std::move(cells)); }
  void summary(const std::string& markdown) {
    if (section_ != nullptr) bench_.report.summary(*section_, markdown);
  }

 private:
  Report::Section& section() {
    if (section_ == nullptr) section_ = &bench_.report.add(name_, title_, columns_);
    return *section_;
  }

  const SimplifyBench& bench_;
  std::string name_, title_;
  std::vector<std::string> columns_;
  Report::Section* section_ = nullptr;
};

std::string geometric_mean_line(const std::vector<double>& values) {
  return "Geometric mean: " + format(geometric_mean(values)) + ".\n";
}

/// Keeps what is a number.
void collect(double value, std::vector<double>& values) {
  if (!std::isnan(value)) values.push_back(value);
}

void named_row(Part& part, const std::string& name, const TriangleMesh& mesh, int normal_to_reach, int high_to_reach) {
  const double tolerance = tolerance_of(mesh, usual_percent);
  Turns normal, high;
  contest(part.options(), {{[&] { return bounded(mesh, within(tolerance)); }, &normal},
                           {[&] { return bounded(mesh, within(tolerance, Effort::High)); }, &high}});
  const Check of_normal = part.checked(name + " normal", mesh, normal, tolerance);
  const Check of_high = part.checked(name + " high", mesh, high, tolerance);
  const auto target = [](int faces) { return faces == 0 ? std::string("-") : std::to_string(faces); };
  part.row({name, std::to_string(mesh.triangles.size()), normal.faces_or_reason(), target(normal_to_reach),
            format(normal.cpu()), format(of_normal.share, 6), format(of_normal.cgal_share, 6), high.faces_or_reason(),
            target(high_to_reach), format(high.cpu()), format(of_high.share, 6), format(of_high.cgal_share, 6),
            format(high.cpu() / normal.cpu())});
}

/// `mesh` and one triangle more.
TriangleMesh with_triangle(TriangleMesh mesh, const Triangle& triangle) {
  mesh.triangles.push_back(triangle);
  return mesh;
}

/// The triangles of the manifold copy: without duplicates and without those of two equal corners.
TriangleMesh cleaned(const TriangleMesh& mesh) { return cgal::to_triangle_mesh(cgal::manifold_copy(mesh).mesh); }

/// Times `what` and the mesh without it in turn.
void degenerate_row(Part& part, const std::string& name, const std::string& what, const TriangleMesh& with,
                    const TriangleMesh& without) {
  const double tolerance = tolerance_of(with, usual_percent);
  Turns ours, clean;
  contest(part.options(), {{[&] { return bounded(with, within(tolerance)); }, &ours},
                           {[&] { return bounded(without, within(tolerance)); }, &clean}});
  const Check check = part.checked(name, with, ours, tolerance);
  part.row({name, what, std::to_string(with.triangles.size()), std::to_string(without.triangles.size()),
            ours.faces_or_reason(), clean.faces_or_reason(), format(ours.cpu()), format(clean.cpu()),
            format(ours.cpu() / clean.cpu()), format(check.share, 6), format(check.cgal_share, 6)});
}

}  // namespace

void named(const SimplifyBench& bench) {
  Part part(bench, "named", "Faces and time of normal and high at 0.1%, one thread",
            {"mesh", "triangles", "normal", "to reach", "normal s", "upper / T", "CGAL's distance / T", "high",
             "to reach", "high s", "upper / T", "CGAL's distance / T", "high / normal s"});
  for (const NamedMesh& m : named_meshes) {
    const auto path = find_dataset({std::string(m.file)});
    if (path && part.wants(m.name)) named_row(part, m.name, read_mesh(*path).mesh, m.normal, m.high);
  }
  if (part.wants("sphere")) named_row(part, "sphere", datasets::icosphere(1, 6), 1000, 840);
}

void blade(const SimplifyBench& bench) {
  struct Level {
    double tolerance;             ///< model units
    const char *faces, *seconds;  ///< as engeom 0.5 publishes them
    const char* reach;            ///< seconds to reach
  };
  constexpr Level levels[] = {{0.005, "40622", "-", "-"},    {0.01, "33954", "-", "1"}, {0.02, "-", "-", "1"},
                              {0.05, "12378", "8.1", "0.8"}, {0.1, "7628", "-", "-"},   {0.5, "2354", "-", "-"}};
  const std::string file = "scan/engeom_engine-blade.off";
  const auto path = find_dataset({file});
  Part part(bench, "blade", "Engine blade, 43,586 triangles, one thread",
            {"tolerance mm", "faces", "engeom 0.5 faces", "s", "s to reach", "engeom 0.5 s", "upper / T",
             "CGAL's distance / T"});
  if (!path || !part.wants(file)) return;
  const TriangleMesh mesh = read_mesh(*path).mesh;
  for (const Level& level : levels) {
    Turns ours;
    contest(bench.options, {{[&] { return bounded(mesh, within(level.tolerance)); }, &ours}});
    const Check check = part.checked(file + " at " + format(level.tolerance), mesh, ours, level.tolerance);
    part.row({format(level.tolerance), ours.faces_or_reason(), level.faces, format(ours.cpu()), level.reach,
              level.seconds, format(check.share, 6), format(check.cgal_share, 6)});
  }
}

void threads(const SimplifyBench& bench) {
  std::vector<Source> sources = named_sources();
  if (!bench.options.quick) {
    constexpr std::size_t triangles_of_the_dragon = 871'414;
    const auto dragon = find_dataset({"npm/dragon_vrip.ply"});
    sources.push_back(dragon ? from_file("dragon", *dragon) : torus(triangles_of_the_dragon));
  }
  constexpr std::size_t min_triangles = 20'000;
  Part part(bench, "threads", "Two threads against one at 0.1%, by the clock (to reach: 1.8)",
            {"mesh", "triangles", "faces", "one s", "two s", "speed-up", "CPU of two / of one", "equal bits"});
  std::vector<double> ratios;
  for (const Source& source : sources) {
    if (!part.wants(source.name)) continue;
    const TriangleMesh mesh = source.make();
    if (mesh.triangles.size() < min_triangles) continue;
    const double tolerance = tolerance_of(mesh, usual_percent);
    Turns one, two;
    contest(bench.options, {{[&] { return bounded(mesh, within(tolerance, Effort::Normal, 1)); }, &one},
                            {[&] { return bounded(mesh, within(tolerance, Effort::Normal, 2)); }, &two}});
    (void)part.checked(source.name, mesh, one, tolerance);
    const bool equal = one.mesh.vertices == two.mesh.vertices && one.mesh.triangles == two.mesh.triangles;
    if (one.done() && two.done() && !equal) part.fail(source.name, "differs between one and two threads");
    const double ratio = one.wall() / two.wall();
    collect(ratio, ratios);
    part.row({source.name, std::to_string(mesh.triangles.size()), one.faces_or_reason(), format(one.wall()),
              format(two.wall()), format(ratio), format(two.cpu() / one.cpu()), equal ? "yes" : "NO"});
    part.summary(geometric_mean_line(ratios));
  }
}

void levels(const SimplifyBench& bench) {
  Part part(bench, "levels", "T/8, T/4, T/2 and T in one run against T alone, T = 0.1%, one thread (to reach: 1.5)",
            {"mesh", "triangles", "faces T/8", "faces T/4", "faces T/2", "faces T", "T alone", "levels s", "alone s",
             "ratio", "greatest upper / T"});
  std::vector<double> ratios;
  for (const Source& source : named_sources()) {
    if (!part.wants(source.name)) continue;
    const TriangleMesh mesh = source.make();
    const double tolerance = tolerance_of(mesh, usual_percent);
    SimplifyOptions with_levels = within(tolerance);
    with_levels.levels = {tolerance / 8, tolerance / 4, tolerance / 2};
    Turns last, alone;
    contest(bench.options, {{[&] { return bounded(mesh, with_levels); }, &last},
                            {[&] { return bounded(mesh, within(tolerance)); }, &alone}});
    double greatest = part.checked(source.name + " T", mesh, last, tolerance).share;
    std::vector<std::string> cells = {source.name, std::to_string(mesh.triangles.size())};
    for (std::size_t k = 0; k < with_levels.levels.size(); ++k) {
      const Turns level = run_once(bench.options, [&] { return bounded(mesh, with_levels, k); });
      const std::string name = source.name + " level " + std::to_string(k);
      greatest = std::max(greatest, part.checked(name, mesh, level, with_levels.levels[k]).share);
      cells.push_back(level.faces_or_reason());
    }
    const double ratio = last.cpu() / alone.cpu();
    collect(ratio, ratios);
    cells.insert(cells.end(), {last.faces_or_reason(), alone.faces_or_reason(), format(last.cpu()), format(alone.cpu()),
                               format(ratio), format(greatest, 6)});
    part.row(std::move(cells));
    part.summary(geometric_mean_line(ratios));
  }
}

void target(const SimplifyBench& bench) {
  constexpr double loose_percent = 5;
  Part part(bench, "target",
            "A number of faces with a tolerance of 5%, beside CGAL to as many, one thread (to reach: 1.2)",
            {"mesh", "triangles", "target", "faces", "CGAL's faces", "s", "CGAL s", "ratio", "upper / T",
             "CGAL's distance / T"});
  std::vector<double> ratios;
  for (const Source& source : named_sources()) {
    if (!part.wants(source.name)) continue;
    const TriangleMesh mesh = source.make();
    const double tolerance = tolerance_of(mesh, loose_percent);
    const CgalInput input = cgal_input(mesh);
    for (const std::size_t share : {2, 10, 50}) {
      SimplifyOptions options = within(tolerance);
      options.target_faces = mesh.triangles.size() / share;
      Turns ours, cgals;
      contest(bench.options, {{[&] { return bounded(mesh, options); }, &ours},
                              {[&] { return unbounded(*input.mesh, ours.faces()); }, &cgals, &ours}});
      const std::string name = source.name + " to " + std::to_string(*options.target_faces);
      const Check check = part.checked(name, mesh, ours, tolerance);
      const double ratio = ours.cpu() / cgals.cpu();
      collect(ratio, ratios);
      part.row({source.name, std::to_string(mesh.triangles.size()), std::to_string(*options.target_faces),
                ours.faces_or_reason(), cgals.faces_or_reason(), format(ours.cpu()), format(cgals.cpu()), format(ratio),
                format(check.share, 6), format(check.cgal_share, 6)});
      part.summary(geometric_mean_line(ratios));
    }
  }
}

void degenerate(const SimplifyBench& bench) {
  Part part(bench, "degenerate", "Degenerate and duplicate triangles against none, 0.1%, one thread (to reach: 1.05)",
            {"mesh", "what", "triangles", "triangles without", "faces", "faces without", "s", "s without", "ratio",
             "upper / T", "CGAL's distance / T"});
  for (const Source& source : named_sources()) {
    if (!part.wants(source.name)) continue;
    const TriangleMesh mesh = source.make();
    const Triangle& first = mesh.triangles[0];
    degenerate_row(part, source.name, "one of zero area", with_triangle(mesh, {first[0], first[0], first[1]}), mesh);
    degenerate_row(part, source.name, "one duplicate", with_triangle(mesh, first), mesh);
  }
  for (const char* file : {"pairs/igea__lod0.1.ply", "pairs/igea__lod0.5.ply", "pairs/bunny__bun_zipper_res2.ply"}) {
    const auto path = find_dataset({file});
    if (!path || !part.wants(file)) continue;
    const TriangleMesh mesh = read_mesh(*path).mesh;
    degenerate_row(part, file, "its own", mesh, cleaned(mesh));
  }
}

void scale(const SimplifyBench& bench) {
  Part part(bench, "scale",
            "Time and memory of large meshes, one thread (to reach: 350 bytes a triangle at 0.1%, 500 at 0.02%)",
            {"mesh", "tolerance %", "triangles", "faces", "s", "bytes a triangle"});
  constexpr std::size_t min_triangles = 60'000;
  std::vector<Source> sources = named_sources();
  const std::size_t max_torus = bench.options.quick ? 300'000 : 10'000'000;
  for (const std::size_t size : {100'000u, 300'000u, 1'000'000u, 3'000'000u, 10'000'000u})
    if (size <= max_torus) sources.push_back(torus(size));
  std::vector<double> sizes, seconds;
  for (const Source& source : sources) {
    if (!part.wants(source.name)) continue;
    const TriangleMesh mesh = source.make();
    const auto triangles = static_cast<double>(mesh.triangles.size());
    if (mesh.triangles.size() < min_triangles) continue;
    for (const double percent : {0.1, 0.02}) {
      const double tolerance = tolerance_of(mesh, percent);
      const Turns ours = run_once(bench.options, [&] { return bounded(mesh, within(tolerance)); });
      if (percent == usual_percent && ours.done() && source.name.rfind("torus", 0) == 0)
        sizes.push_back(triangles), seconds.push_back(ours.cpu());
      (void)part.checked(source.name + " at " + format(percent), mesh, ours, tolerance);
      part.row({source.name, format(percent), std::to_string(mesh.triangles.size()), ours.faces_or_reason(),
                format(ours.cpu()), format(ours.peak_growth / triangles)});
    }
    if (sizes.size() > 1)
      part.summary("Torus at 0.1%: time grows with the power " + format(fitted_exponent(sizes, seconds)) +
                   " of the size.\n");
  }
}

}  // namespace meshbound::bench
