// SPDX-License-Identifier: MIT
/// The lines on stdout by which every tool says how far two meshes are apart. Bounds and coordinates have the fewest
/// digits that read back as the same double.
#pragma once
#include <optional>
#include <string>
#include <utility>

#include "meshbound/distance.h"
#include "meshbound/report.h"

namespace meshbound::tools {

/// "1 face", "2 faces".
[[nodiscard]] std::string face_count(std::size_t faces);

/// A line "label       text"; a label that is empty continues the line above.
void print_line(const std::string& label, const std::string& text);

/// "[0.0013, 0.0014]", or "at least 0.0013" where there is no upper bound.
[[nodiscard]] std::string interval(const Bounds& bounds);

/// "0.13% to 0.14% of the diagonal", or "0.13% or more of the diagonal" where there is no upper bound.
[[nodiscard]] std::string share_of_diagonal(const Bounds& bounds, double diagonal);

/// Prints an interval of lengths behind `text`, and below it the same in percent of the diagonal.
void print_interval(const std::string& label, const std::string& text, const Bounds& bounds, double diagonal);

/// Prints what was read: file, size, diagonal, and what the reader did. `name` is "A" or "B".
void print_mesh(const char* name, const MeshReport& mesh);

/// Prints the question about two meshes: their lines, the tolerance, and the error bound with the reason why it was not
/// reached (empty: it was).
void print_question(const MeshReport& a, const MeshReport& b, const std::optional<double>& tolerance,
                    const std::optional<double>& error_bound, const std::string& reason);

/// "(-0.9880000000000001 19.617 2.367)": digits that read back as the same doubles.
[[nodiscard]] std::string exact_point(const Eigen::Vector3d& p);

/// "(-0.988 19.617 2.367)"
[[nodiscard]] std::string short_point(const Eigen::Vector3d& p);

/// Two numbers with the fewest digits, but at least six, that show which of them is larger.
[[nodiscard]] std::pair<std::string, std::string> told_apart(double larger, double smaller);

/// "0.012", and "; 2 threads": for lines that tell the time.
[[nodiscard]] std::string rounded_seconds(double seconds);
[[nodiscard]] std::string thread_count(int threads);

/// Names of the two directions: "A to B", "original to simplified".
struct DirectionNames {
  const char* a_to_b;
  const char* b_to_a;
};

/// Prints the interval of the distance in model units and in percent of the diagonal, then each direction with its
/// interval and its witness: a point of one mesh and the closest point of the other. `b_to_a` may be null: not asked
/// for.
void print_distance(const Bounds& bounds, const OneSidedDistance& a_to_b, const OneSidedDistance* b_to_a,
                    const DirectionNames& names, double diagonal);

}  // namespace meshbound::tools
