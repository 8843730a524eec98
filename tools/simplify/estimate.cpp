// SPDX-License-Identifier: MIT
#include "simplify/estimate.h"

#include <cmath>
#include <string>

#include "common/distance_text.h"
#include "common/length.h"

namespace meshbound::tools {

void print_estimate(std::size_t faces, double tolerance, double diagonal) {
  constexpr double bytes_a_triangle = 500, seconds_a_triangle = 20e-6;  // of one thread, from 10e-6 to 40e-6
  constexpr double mebibyte = 1024 * 1024;
  const auto triangles = static_cast<double>(faces);
  print_line("faces", std::to_string(faces));
  print_line("tolerance", both_units(tolerance, diagonal));
  print_line("memory", "about " + short_number(std::ceil(bytes_a_triangle * triangles / mebibyte)) + " MiB");
  print_line("time",
             "about " + rounded_seconds(seconds_a_triangle * triangles) + " s on one thread, half to twice that");
  print_line("dry run", "nothing was written");
}

}  // namespace meshbound::tools
