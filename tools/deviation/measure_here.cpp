// SPDX-License-Identifier: MIT
#include "deviation/measure_here.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "deviation/packed_numbers.h"
#include "mesh/file_bytes.h"
#include "mesh/writers.h"
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

MeasureHere impossible(const std::string& reason) { return {Json{{"reason", reason}}.dump(), ""}; }

MeasureHere too_large() {
  return impossible("The meshes are too large to be in this page; the tool hausdorff_distance measures them.");
}

std::optional<std::string> engine_script() {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  const fs::path file = program.parent_path().parent_path() / "share/meshbound/report_engine.js";
  if (error || !fs::is_regular_file(file, error)) return std::nullopt;
  return std::string(FileBytes(file, {}).bytes());
}

}  // namespace

MeasureHere MeasureHere::within(std::size_t max_bytes) const {
  return measurement.size() + engine.size() > max_bytes && !engine.empty() ? too_large() : *this;
}

MeasureHere measure_here(const RepeatedMeasurement& measurement, const TriangleMesh& first,
                         const TriangleMesh& second) {
  if (!measurement.obstacle.empty()) return impossible(measurement.obstacle);
  constexpr std::size_t max_bytes = 20'000'000;  // more is not worth packing: a report is smaller
  const bool first_in_floats = holds_floats(first), second_in_floats = holds_floats(second);
  if (bytes_of(first, first_in_floats) + bytes_of(second, second_in_floats) > max_bytes) return too_large();
  std::optional<std::string> engine = engine_script();
  if (!engine)
    return impossible(
        "The tool that made this report was built without its engine in WebAssembly, which would repeat the "
        "measurement "
        "here.");
  const Json json = {{"decides", measurement.decides},
                     {"error_bound", number_or_null(measurement.error_bound)},
                     {"tolerance", number_or_null(measurement.tolerance)},
                     {"one_sided", measurement.one_sided},
                     {"first", whole_mesh(first, first_in_floats)},
                     {"second", whole_mesh(second, second_in_floats)}};
  return {json.dump(), std::move(*engine)};
}

}  // namespace meshbound::tools
