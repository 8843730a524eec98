// SPDX-License-Identifier: MIT
#include "hausdorff/text_report.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include "common/length.h"

namespace meshbound::tools {
namespace {

void print_mesh(const char* name, const MeshReport& mesh) {
  const MeshSummary& s = mesh.summary;
  std::printf("%s  %s: %zu triangles, %zu vertices, %zu component%s, %s, diagonal %s\n", name, mesh.path.c_str(),
              s.faces, s.vertices, s.components, s.components == 1 ? "" : "s", s.closed ? "closed" : "open",
              short_number(s.bbox_diagonal).c_str());
  if (mesh.triangulated_polygons > 0) std::printf("   %zu polygons split into triangles\n", mesh.triangulated_polygons);
  if (mesh.decoded_strips > 0) std::printf("   %zu triangle strips decoded\n", mesh.decoded_strips);
  if (mesh.ignored_elements > 0) std::printf("   %zu lines, points or empty faces ignored\n", mesh.ignored_elements);
}

/// `no_upper` says why there is no upper bound, where there is none.
void print_bounds(const char* label, const Bounds& bounds, const char* no_upper, double diagonal) {
  const bool has_upper = std::isfinite(bounds.upper);
  std::printf("%-20s lower %s, upper %s\n", label, exact_number(bounds.lower).c_str(),
              has_upper ? exact_number(bounds.upper).c_str() : no_upper);
  std::printf("%-20s %s %s\n", "", both_units(bounds.lower, diagonal).c_str(),
              has_upper ? ("to " + both_units(bounds.upper, diagonal)).c_str() : "or more");
}

std::string exact_point(const Eigen::Vector3d& p) {
  return "(" + exact_number(p.x()) + " " + exact_number(p.y()) + " " + exact_number(p.z()) + ")";
}

std::string short_point(const Eigen::Vector3d& p) {
  return "(" + short_number(p.x()) + " " + short_number(p.y()) + " " + short_number(p.z()) + ")";
}

void print_direction(const char* label, const OneSidedDistance& distance, double diagonal) {
  if (!was_searched(distance)) {
    std::printf("%-20s not searched\n", label);
    return;
  }
  print_bounds(label, distance.bounds, "not known", diagonal);
  std::printf("%-20s from %s to %s\n", "  witness", exact_point(distance.witness.from.position).c_str(),
              exact_point(distance.witness.nearest.position).c_str());
}

/// The mesh is named where it is B: a reader of a log expects A, the original.
std::string place(const WorstSpot& worst) {
  return short_point(worst.point.position) + ", triangle " + std::to_string(worst.point.triangle) +
         (worst.on_a ? "" : " of B");
}

unsigned long long count(std::uint64_t n) { return n; }  // printf has no portable letter for it

void print_profile(const char* label, const OneSidedDistance& distance) {
  const DistanceStats& s = distance.stats;
  std::printf("%-20s %.3f%% culled on A, %.5f%% culled on B\n", label, s.culled_on_a_percent, s.culled_on_b_percent);
  std::printf("%-20s %llu triangles: %llu identical, %llu culled by node, %llu by their corners, %llu subdivided\n", "",
              count(s.triangles), count(s.matched), count(s.culled_by_node), count(s.culled_by_vertices),
              count(s.walked));
  std::printf("%-20s %llu queries, %llu nodes, %llu triangles tested\n", "", count(s.closest_point_queries),
              count(s.nodes_visited), count(s.triangles_tested));
  std::printf("%-20s %llu subdivisions into %llu pieces, %u deep; %llu resolved, %llu enclosed, %llu given up\n", "",
              count(s.subdivisions), count(s.pieces), s.deepest_subdivision, count(s.resolved), count(s.enclosed),
              count(s.given_up));
  std::printf("%-20s matching %.4f s, culling on A %.4f s, on B %.4f s, subdivision %.4f s\n", "", s.phases.matching,
              s.phases.culling_on_a, s.phases.culling_on_b, s.phases.subdivision);
}

/// Two numbers with as few digits, six or more, as show which of them is larger.
std::pair<std::string, std::string> told_apart(double larger, double smaller) {
  char first[32], second[32];
  for (int digits = 6;; ++digits) {
    std::snprintf(first, sizeof first, "%.*g", digits, larger);
    std::snprintf(second, sizeof second, "%.*g", digits, smaller);
    if (digits == 17 || std::strtod(first, nullptr) > std::strtod(second, nullptr)) return {first, second};
  }
}

std::string failure(const DistanceReport& report) {
  const auto [distance, tolerance] = told_apart(report.bounds.lower, *report.tolerance);
  const std::string line = "FAIL " + distance + " > " + tolerance;
  return report.worst ? line + " at " + place(*report.worst) : line;
}

std::string undecided(const DistanceReport& report) {
  const Bounds& bounds = report.bounds;
  std::string line = "UNDECIDED";
  if (!std::isfinite(bounds.upper)) {
    line += " no upper bound yet";
  } else if (report.tolerance) {
    line += " tolerance " + exact_number(*report.tolerance) + " in [" + exact_number(bounds.lower) + ", " +
            exact_number(bounds.upper) + "]";
  } else {
    const auto [width, wanted] = told_apart(bounds.upper - bounds.lower, *report.error_bound);
    line += " width " + width + " > " + wanted;
  }
  return line + ": " + report.reason;
}

}  // namespace

void print_report(const DistanceReport& report, bool profile) {
  const double diagonal = report.a.summary.bbox_diagonal;
  print_mesh("A", report.a);
  print_mesh("B", report.b);
  print_direction("A to B", report.a_to_b, diagonal);
  if (report.b_to_a) {
    print_direction("B to A", *report.b_to_a, diagonal);
    const bool all_searched = was_searched(report.a_to_b) && was_searched(*report.b_to_a);
    print_bounds("Hausdorff distance", report.bounds, all_searched ? "not known" : "not searched", diagonal);
  }
  if (report.worst_was_wanted && report.worst)
    std::printf("%-20s %s%s\n", "worst spot", place(*report.worst).c_str(), report.worst->on_a ? " of A" : "");
  if (report.error_bound)
    std::printf("%-20s %s%s\n", "error bound", both_units(*report.error_bound, diagonal).c_str(),
                report.reason.empty() ? "" : (", not reached: " + report.reason).c_str());
  if (report.tolerance) std::printf("%-20s %s\n", "tolerance", both_units(*report.tolerance, diagonal).c_str());
  if (report.transform_displacement)
    std::printf("%-20s %s, within the bounds\n", "transform rounding",
                short_number(*report.transform_displacement).c_str());
  std::printf("%-20s %s\n", "verdict", report.verdict.c_str());
  std::printf("%-20s read %.3f s, build %.3f s, query %.3f s, total %.3f s; %d thread%s\n", "time", report.seconds.read,
              report.seconds.build, report.seconds.query, report.seconds.total, report.threads,
              report.threads == 1 ? "" : "s");
  if (profile) print_profile("profile A to B", report.a_to_b);
  if (profile && report.b_to_a) print_profile("profile B to A", *report.b_to_a);
  if (const std::string line = closing_line(report); !line.empty()) std::printf("%s\n", line.c_str());
}

std::string closing_line(const DistanceReport& report) {
  if (report.verdict == "exceeds") return failure(report);
  return report.verdict == "undecided" ? undecided(report) : "";
}

}  // namespace meshbound::tools
