// SPDX-License-Identifier: MIT
#include "common/distance_text.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include "common/length.h"
#include "meshbound/report.h"

namespace meshbound::tools {
namespace {

std::string percent(double length, double diagonal) { return short_number(length / diagonal * 100) + "%"; }

void print_direction(const char* name, const OneSidedDistance& distance) {
  if (!was_searched(distance)) {
    std::printf("  %s not searched\n", name);
    return;
  }
  std::printf("  %s %s\n", name, interval(distance.bounds).c_str());
  print_line("", "witness " + exact_point(distance.witness.from.position) + " to " +
                     exact_point(distance.witness.nearest.position));
}

}  // namespace

void print_line(const std::string& label, const std::string& text) {
  std::printf("%-11s %s\n", label.c_str(), text.c_str());
}

std::string interval(const Bounds& bounds) {
  if (!std::isfinite(bounds.upper)) return "at least " + exact_number(bounds.lower);
  return "[" + exact_number(bounds.lower) + ", " + exact_number(bounds.upper) + "]";
}

std::string share_of_diagonal(const Bounds& bounds, double diagonal) {
  const std::string upper = std::isfinite(bounds.upper) ? " to " + percent(bounds.upper, diagonal) : " or more";
  return percent(bounds.lower, diagonal) + upper + " of the diagonal";
}

void print_interval(const std::string& label, const std::string& text, const Bounds& bounds, double diagonal) {
  print_line(label, text + interval(bounds));
  if (diagonal > 0 && std::isfinite(bounds.lower / diagonal * 100)) print_line("", share_of_diagonal(bounds, diagonal));
}

void print_mesh(const char* name, const MeshReport& mesh) {
  const MeshSummary& s = mesh.summary;
  print_line(name, mesh.path + ": " + std::to_string(s.faces) + " triangles, " + std::to_string(s.vertices) +
                       " vertices, " + std::to_string(s.components) +
                       (s.components == 1 ? " component, " : " components, ") + (s.closed ? "closed" : "open") +
                       ", diagonal " + short_number(s.bbox_diagonal));
  if (mesh.triangulated_polygons > 0)
    print_line("", std::to_string(mesh.triangulated_polygons) + " polygons split into triangles");
  if (mesh.decoded_strips > 0) print_line("", std::to_string(mesh.decoded_strips) + " triangle strips decoded");
  if (mesh.ignored_elements > 0)
    print_line("", std::to_string(mesh.ignored_elements) + " lines, points or empty faces ignored");
}

void print_question(const MeshReport& a, const MeshReport& b, const std::optional<double>& tolerance,
                    const std::optional<double>& error_bound, const std::string& reason) {
  const double diagonal = a.summary.bbox_diagonal;
  print_mesh("A", a);
  print_mesh("B", b);
  if (tolerance) print_line("tolerance", both_units(*tolerance, diagonal));
  if (error_bound)
    print_line("error bound", both_units(*error_bound, diagonal) + (reason.empty() ? "" : ", not reached: " + reason));
}

std::string exact_point(const Eigen::Vector3d& p) {
  return "(" + exact_number(p.x()) + " " + exact_number(p.y()) + " " + exact_number(p.z()) + ")";
}

std::string face_count(std::size_t faces) { return std::to_string(faces) + (faces == 1 ? " face" : " faces"); }

std::string short_point(const Eigen::Vector3d& p) {
  return "(" + short_number(p.x()) + " " + short_number(p.y()) + " " + short_number(p.z()) + ")";
}

std::pair<std::string, std::string> told_apart(double larger, double smaller) {
  char first[32], second[32];
  for (int digits = 6;; ++digits) {
    std::snprintf(first, sizeof first, "%.*g", digits, larger);
    std::snprintf(second, sizeof second, "%.*g", digits, smaller);
    if (digits == 17 || std::strtod(first, nullptr) > std::strtod(second, nullptr)) return {first, second};
  }
}

std::string rounded_seconds(double seconds) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3f", seconds);
  return text;
}

std::string thread_count(int threads) {
  return "; " + std::to_string(threads) + (threads == 1 ? " thread" : " threads");
}

void print_distance(const Bounds& bounds, const OneSidedDistance& a_to_b, const OneSidedDistance* b_to_a,
                    const DirectionNames& names, double diagonal) {
  print_interval("distance", "", bounds, diagonal);
  print_direction(names.a_to_b, a_to_b);
  if (b_to_a != nullptr) print_direction(names.b_to_a, *b_to_a);
}

}  // namespace meshbound::tools
