// SPDX-License-Identifier: MIT
#include "common/memory.h"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "common/whole_number.h"
#include "meshbound/error.h"
#include "meshbound/triangle_mesh.h"

namespace meshbound::tools {
namespace {

/// Bytes for the program, its libraries and their stacks.
constexpr double bytes_of_program = 64.0 * 1024 * 1024;

/// Bytes of one tile in work.
double bytes_of_tile(std::size_t triangles, const TileOptions& tiles, const TileCost& cost) {
  return cost.tile * static_cast<double>(std::min(triangles, tiles.max_triangles));
}

/// Bytes beside the program that one thread needs for meshes with this many triangles.
double bytes_of_work(std::size_t triangles, const TileOptions& tiles, const TileCost& cost) {
  return cost.whole * static_cast<double>(triangles) + bytes_of_tile(triangles, tiles, cost);
}

/// No program runs within less: a limit below it has lost its unit.
constexpr std::uint64_t min_limit = std::uint64_t{1} << 20;

/// Whether the limit is that of --memory; any other one was set before this program was started.
bool has_own_limit = false;

}  // namespace

std::uint64_t parse_memory(const std::string& option, const std::string& text) {
  constexpr std::string_view units = "KMGT";
  const std::size_t unit = text.empty() ? std::string_view::npos : units.find(text.back());
  const int shift = unit == std::string_view::npos ? 0 : 10 * (static_cast<int>(unit) + 1);
  const auto value = whole_number(std::string_view(text).substr(0, text.size() - (shift > 0 ? 1 : 0)));
  if (!value || *value == 0 || *value > (std::uint64_t{1} << (62 - shift)))
    throw InvalidInput(option + " " + text + ": give a number of bytes, or one with K, M, G or T, such as 4G");
  const std::uint64_t bytes = *value << shift;
  if (bytes < min_limit)
    throw InvalidInput(
        option + " " + text + ": " +
        (shift == 0 ? text + (bytes == 1 ? " is 1 byte" : " is " + text + " bytes") + "; did you mean " + text + "G?"
                    : "less than 1 MiB; did you mean " + std::to_string(*value) + "G?"));
  return bytes;
}

void limit_memory(std::uint64_t bytes) {
  const rlimit limit{bytes, bytes};
  has_own_limit = ::setrlimit(RLIMIT_DATA, &limit) == 0;
}

std::string out_of_memory(const std::string& tool) {
  rlimit limit{};
  if (::getrlimit(RLIMIT_DATA, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return "out of memory";
  const bool has_batch = tool == "simplify_with_bound",
             simplifies = has_batch || tool == "simplify_with_bound_mpi" || tool == "lod_chain";
  const std::string outer = has_batch ? "--memory-limit of the batch, or ulimit -d" : "ulimit -d";
  return "out of memory within " + in_mebibytes(static_cast<double>(limit.rlim_cur)) + ": allow more (" +
         (has_own_limit ? "--memory" : outer) + ")" +
         (simplifies ? ", or a larger tolerance, which leaves fewer triangles" : "");
}

std::uint64_t peak_memory() {
  constexpr std::uint64_t kibibyte = 1024;
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return kibibyte * static_cast<std::uint64_t>(usage.ru_maxrss);
}

std::string in_mebibytes(double bytes) {
  constexpr double mebibyte = 1024.0 * 1024;
  return std::to_string(static_cast<std::uint64_t>(std::ceil(bytes / mebibyte))) + " MiB";
}

bool fits_to_compare(std::size_t vertices, std::size_t triangles, const TileOptions& tiles) {
  constexpr double arrays_and_tables = 3;  // times the arrays
  const double arrays = static_cast<double>(vertices * sizeof(Eigen::Vector3d) + triangles * sizeof(Triangle));
  return arrays_and_tables * arrays <= bytes_of_work(triangles, tiles, cost_of_measuring);
}

int threads_within(std::uint64_t limit, const std::string& option, std::size_t triangles, const TileOptions& tiles,
                   const TileCost& cost, int wanted) {
  const double tile = bytes_of_tile(triangles, tiles, cost);
  const double least = bytes_of_program + bytes_of_work(triangles, tiles, cost);
  const double room = (static_cast<double>(limit) - least) / tile + 1;
  if (room < 1)
    throw InvalidInput(option + ": " + std::to_string(triangles) + " triangles need at least " + in_mebibytes(least));
  return static_cast<int>(std::min(room, static_cast<double>(wanted)));
}

}  // namespace meshbound::tools
