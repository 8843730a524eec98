// SPDX-License-Identifier: MIT
#include "common/distance_text.h"

#include <cmath>
#include <cstdio>

#include "common/length.h"
#include "meshbound/report.h"

namespace meshbound::tools {
namespace {

std::string exact_point(const Eigen::Vector3d& p) {
  return "(" + exact_number(p.x()) + " " + exact_number(p.y()) + " " + exact_number(p.z()) + ")";
}

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
  print_line("distance", interval(bounds));
  if (diagonal > 0 && std::isfinite(bounds.lower / diagonal * 100)) {
    const bool has_upper = std::isfinite(bounds.upper);
    print_line("", percent(bounds.lower, diagonal) + (has_upper ? " to " + percent(bounds.upper, diagonal) : "") +
                       (has_upper ? "" : " or more") + " of the diagonal");
  }
  print_direction(names.a_to_b, a_to_b);
  if (b_to_a != nullptr) print_direction(names.b_to_a, *b_to_a);
}

}  // namespace meshbound::tools
