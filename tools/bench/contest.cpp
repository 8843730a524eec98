// SPDX-License-Identifier: GPL-3.0-or-later
#include "contest.h"

#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "cgal_functions.h"
#include "measure.h"
#include "meshbound/error.h"

namespace meshbound::bench {
namespace {

constexpr double none = Check::none;

/// CGAL's distance may be off by its error bound.
constexpr double cgal_error = 1e-3;  // tolerances

/// A field of /proc/self/status that is given in kB, in bytes.
double status_bytes(const std::string& field) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.rfind(field + ':', 0) == 0) return 1024 * std::stod(line.substr(field.size() + 1));
  return none;
}

/// What a child process hands back before the mesh.
enum Value : std::size_t { Cpu, Wall, SecondsInAll, PeakGrowth, FirstOfMesh };

std::vector<double> repeated(const std::function<Simplified()>& simplify, bool with_mesh) {
  constexpr double enough_seconds = 0.1;
  constexpr std::size_t max_repetitions = 25;
  std::vector<double> cpus, walls;
  double used = 0, growth = 0;
  const double before = status_bytes("RssAnon");
  Simplified last;
  do {
    last = simplify();
    // Pages of the program and its libraries are read in as they are used: not what the mesh needs.
    if (cpus.empty()) growth = status_bytes("VmHWM") - status_bytes("RssFile") - before;
    cpus.push_back(last.cpu), walls.push_back(last.wall);
    used += last.cpu;
  } while (used < enough_seconds && cpus.size() < max_repetitions);
  std::vector<double> values = {median(cpus), median(walls), used, growth};
  if (!with_mesh) return values;
  values.push_back(static_cast<double>(last.mesh.vertices.size()));
  for (const Eigen::Vector3d& p : last.mesh.vertices) values.insert(values.end(), p.begin(), p.end());
  for (const Triangle& t : last.mesh.triangles) values.insert(values.end(), t.begin(), t.end());
  return values;
}

TriangleMesh mesh_of(const std::vector<double>& values) {
  std::size_t at = FirstOfMesh;
  TriangleMesh mesh;
  mesh.vertices.resize(static_cast<std::size_t>(values[at++]));
  for (Eigen::Vector3d& p : mesh.vertices)
    for (double& x : p) x = values[at++];
  mesh.triangles.resize((values.size() - at) / 3);
  for (Triangle& t : mesh.triangles)
    for (std::uint32_t& v : t) v = static_cast<std::uint32_t>(values[at++]);
  return mesh;
}

/// Returns the seconds that the turn took, negative where it came to no end.
double turn(const Options& options, const Contender& contender) {
  if (contender.after != nullptr && !contender.after->done()) return -1;
  Turns& into = *contender.into;
  const bool first = into.cpus.empty();
  ::malloc_trim(0);  // or the child fills what this process has freed, and seems to need less
  const ChildResult child = run_in_child(options.limit, [&] { return repeated(contender.simplify, first); });
  into.status = child.status;
  into.error = child.error;
  if (!into.done()) return -1;
  into.cpus.push_back(child.values[Cpu]);
  into.walls.push_back(child.values[Wall]);
  if (first) into.mesh = mesh_of(child.values), into.peak_growth = child.values[PeakGrowth];
  return child.values[SecondsInAll];
}

TriangleMesh manifold_soup(const TriangleMesh& mesh) { return cgal::to_triangle_mesh(*cgal_input(mesh).mesh); }

double value_or_none(const ChildResult& child, std::size_t i) {
  return child.status == ChildResult::Status::Done && i < child.values.size() ? child.values[i] : none;
}

}  // namespace

double Turns::cpu() const { return cpus.empty() ? none : median(cpus); }
double Turns::wall() const { return walls.empty() ? none : median(walls); }

std::string Turns::faces_or_reason() const {
  if (!cpus.empty()) return std::to_string(faces());
  if (status == ChildResult::Status::TimedOut) return "not in time";
  std::string reason = error.empty() ? "-" : error.substr(0, error.find('\n'));
  std::replace(reason.begin(), reason.end(), ',', ';');  // a cell of a table
  return reason;
}

void contest(const Options& options, const std::vector<Contender>& contenders) {
  const std::size_t rounds = options.quick ? 3 : 5;
  const double seconds = options.quick ? 1 : 8;
  std::vector<Contestant> turns;
  for (const Contender& contender : contenders)
    turns.emplace_back([&options, &contender] { return turn(options, contender); });
  interleave(turns, rounds, seconds);
}

Turns run_once(const Options& options, const std::function<Simplified()>& simplify) {
  Turns turns;
  turn(options, {simplify, &turns});
  return turns;
}

bool Check::holds() const { return !(share > 1) && !(cgal_share > 1 + cgal_error); }

Check check(const Options& options, const TriangleMesh& original, const TriangleMesh& simplified, double tolerance) {
  const ChildResult ours = run_in_child(options.limit, [&]() -> std::vector<double> {
    return {share_of_tolerance(original, simplified, tolerance), seconds_of_measuring(original, simplified, tolerance)};
  });
  const ChildResult cgals = run_in_child(options.check_limit, [&]() -> std::vector<double> {
    const auto pair = CgalPair::make(manifold_soup(original), manifold_soup(simplified));
    return {pair ? pair->bounded_error(cgal_error * tolerance) / tolerance : none};
  });
  return {value_or_none(ours, 0), value_or_none(cgals, 0), value_or_none(ours, 1)};
}

CgalInput cgal_input(const TriangleMesh& mesh) {
  try {
    return {cgal::to_surface_mesh(mesh), "as it is"};
  } catch (const InvalidInput&) {
  }
  try {
    return {cgal::manifold_copy(mesh).mesh, "manifold copy"};
  } catch (const Error& error) {
    return {std::nullopt, "no Surface_mesh"};
  }
}

}  // namespace meshbound::bench
