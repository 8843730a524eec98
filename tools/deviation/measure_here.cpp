// SPDX-License-Identifier: MIT
#include "deviation/measure_here.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "deviation/packed_numbers.h"
#include "mesh/file_bytes.h"
#include "mesh/round_to_floats.h"
#include "meshbound/error.h"

namespace meshbound::tools {
namespace {

using Json = nlohmann::ordered_json;

/// Whether floats hold every coordinate as it is.
bool holds_floats(const TriangleMesh& mesh) {
  return std::all_of(mesh.vertices.begin(), mesh.vertices.end(),
                     [](const Eigen::Vector3d& p) { return rounded_to_float(p) == p; });
}

std::size_t bytes_of(const TriangleMesh& mesh, bool in_floats) {
  const std::size_t position = 3 * (in_floats ? sizeof(float) : sizeof(double));
  return (mesh.vertices.size() * position + mesh.triangles.size() * sizeof(Triangle)) / 3 * 4;
}

Json whole_mesh(const TriangleMesh& mesh, bool in_floats) {
  PackedNumbers positions;
  for (const Eigen::Vector3d& p : mesh.vertices) {
    for (const double x : p) {
      if (in_floats)
        positions.add(static_cast<float>(x));
      else
        positions.add(x);
    }
  }
  return {{"type", in_floats ? "float32" : "float64"},
          {"positions", positions.text()},
          {"triangles", packed_indices(mesh.triangles)}};
}

Json number_or_null(const std::optional<double>& number) { return number ? Json(*number) : Json(); }

constexpr const char* absent = "null";

MeasureHere impossible(const std::string& reason) { return {Json{{"reason", reason}}.dump(), absent, absent, ""}; }

std::optional<std::string> engine_script() {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  const fs::path file = program.parent_path().parent_path() / "share/meshbound/report_engine.js";
  if (error || !fs::is_regular_file(file, error)) return std::nullopt;
  return std::string(FileBytes(file, {}).bytes());
}

}  // namespace

std::string MeasureHere::measurement() const {
  return "{\"options\":" + options + ",\"first\":" + first + ",\"second\":" + second + "}";
}

MeasureHere MeasureHere::within(std::size_t max_bytes) const {
  if (first.size() + second.size() + engine.size() <= max_bytes) return *this;
  return {options, absent, absent, engine};
}

MeasureHere measure_here(const RepeatedMeasurement& measurement, const TriangleMesh& first,
                         const TriangleMesh& second) {
  if (!measurement.obstacle.empty()) return impossible(measurement.obstacle);
  std::optional<std::string> engine = engine_script();
  if (!engine)
    return impossible(
        "The tool that made this report was built without its engine in WebAssembly, which would repeat the "
        "measurement "
        "here.");
  const Json options = {{"decides", measurement.decides},
                        {"error_bound", number_or_null(measurement.error_bound)},
                        {"tolerance", number_or_null(measurement.tolerance)},
                        {"one_sided", measurement.one_sided}};
  constexpr std::size_t max_bytes = 20'000'000;  // more is not worth packing: a report is smaller
  const bool first_in_floats = holds_floats(first), second_in_floats = holds_floats(second);
  if (bytes_of(first, first_in_floats) + bytes_of(second, second_in_floats) > max_bytes)
    return {options.dump(), absent, absent, std::move(*engine)};
  return {options.dump(), whole_mesh(first, first_in_floats).dump(), whole_mesh(second, second_in_floats).dump(),
          std::move(*engine)};
}

}  // namespace meshbound::tools
