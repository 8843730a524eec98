// SPDX-License-Identifier: MIT
// The volumes that two closed meshes have in common, and how deep each is, as proven intervals.
#include "meshbound/penetration_depth.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "common/affine_argument.h"
#include "common/mesh_input.h"
#include "common/output.h"
#include "common/progress.h"
#include "common/provenance.h"
#include "common/run_clock.h"
#include "common/run_limits.h"
#include "common/signals.h"
#include "common/threads.h"
#include "common/tool_main.h"
#include "meshbound/error.h"
#include "meshbound/pose.h"
#include "meshbound/transform.h"
#include "penetration/arguments.h"
#include "penetration/parts_file.h"
#include "penetration/report.h"

namespace {

using namespace meshbound;
using namespace meshbound::tools;

/// One of the two meshes, from reading to a placed model.
struct Input {
  TriangleMesh mesh;
  Pose pose = Pose::Identity();
  std::optional<double> displacement;
  std::unique_ptr<ClosedModel> model;
};

/// Whether `penetration_depth` takes the map as a pose: its columns are orthonormal up to the rounding of the program
/// that wrote them, and it is no reflection.
bool is_rigid(const AffineMap& map) {
  constexpr double max_drift = 1e-10;
  const Eigen::Matrix3d linear = map.linear();
  return (linear.transpose() * linear - Eigen::Matrix3d::Identity()).norm() <= max_drift && linear.determinant() > 0;
}

/// Makes a rigid map the pose of the model. Any other map is applied here, each coordinate rounded once; if it
/// reflects, triangles are reversed.
void place(Input& input, const AffineMap& map) {
  if (is_rigid(map)) {
    input.pose.matrix() = map.matrix();
    return;
  }
  TransformedMesh image = transformed(input.mesh, map);
  input.mesh = std::move(image.mesh);
  input.displacement = image.displacement_bound;
  if (map.linear().determinant() < 0)
    for (Triangle& t : input.mesh.triangles) std::swap(t[1], t[2]);
}

/// Reads a mesh and places it.
void load(const std::string& path, const std::optional<AffineMap>& map, bool with_checksum, const StopToken& stop,
          Input& input, MeshReport& report) {
  input.mesh = read_input(path, with_checksum, report, stop);
  report.dropped.reset();  // nothing is written again
  if (!map) return;
  place(input, *map);
  if (input.displacement) report.summary = summarise(input.mesh);
}

/// Checks that a mesh bounds a solid; the message names the file.
void check(const std::string& path, const StopToken& stop, Input& input) {
  try {
    input.model = std::make_unique<ClosedModel>(input.mesh, BvhOptions{.threads = 1, .stop = stop});
  } catch (const InvalidInput& error) {
    throw InvalidInput(path + ": " + error.what());
  }
}

PenetrationOptions engine_options(const PenetrationArguments& arguments, const PenetrationReport& report,
                                  const RunClock& clock, ProgressBar& bar) {
  PenetrationOptions options;
  options.error_bound = report.error_bound;
  if (!report.error_bound) options.decide = report.tolerance;
  options.keep_parts = !arguments.output.empty();
  set_run_limits(options, arguments.common, clock, bar);
  return options;
}

/// Fills in what is asked, with lengths in model units.
void fill_question(const PenetrationLengths& lengths, PenetrationReport& report) {
  constexpr double default_share = 1e-6;
  const double diagonal = report.a.summary.bbox_diagonal;
  if (lengths.tolerance) report.tolerance = lengths.tolerance->in_model_units(diagonal);
  if (lengths.error_bound) report.error_bound = lengths.error_bound->in_model_units(diagonal);
  if (!lengths.tolerance && !lengths.error_bound) report.error_bound = default_share * diagonal;
}

const char* contact_of(const PenetrationDepth& depth, const PlacedClosedModel& a, const PlacedClosedModel& b) {
  if (!depth.volumes_known) return "unknown";
  if (!depth.volumes.empty()) return "overlapping";
  return in_contact(a, b) ? "touching" : "none";
}

int run(const PenetrationArguments& arguments) {
  RunClock clock(arguments.common);
  const PenetrationLengths lengths = check_arguments(arguments);
  std::optional<AffineMap> map_a, map_b;
  if (!arguments.transform_a.empty()) map_a = parse_affine("--transform-a", arguments.transform_a);
  if (!arguments.transform_b.empty()) map_b = parse_affine("--transform-b", arguments.transform_b);

  PenetrationReport report;
  Input a, b;
  const bool with_checksums = !arguments.common.json.empty();
  const int threads = arguments.common.threads;
  const StopToken stop = clock.stop_of_reading();
  run_both(
      threads, [&] { load(arguments.a, map_a, with_checksums, stop, a, report.a); },
      [&] { load(arguments.b, map_b, with_checksums, stop, b, report.b); });
  report.displacement_a = a.displacement;
  report.displacement_b = b.displacement;
  report.seconds.read = clock.lap();
  const StopToken stop_checking = clock.stop(patience);
  run_both(
      threads, [&] { check(arguments.a, stop_checking, a); }, [&] { check(arguments.b, stop_checking, b); });
  report.seconds.check = clock.lap();

  fill_question(lengths, report);
  const PlacedClosedModel placed_a(*a.model, a.pose), placed_b(*b.model, b.pose);
  {
    ProgressBar bar("measuring", arguments.common.quiet);
    report.result = penetration_depth(placed_a, placed_b, engine_options(arguments, report, clock, bar));
  }
  report.contact = contact_of(report.result, placed_a, placed_b);
  const ExitCode code = conclude(report);
  if (interrupted() && code == ExitUndecided) throw Error("interrupted before the depths were known");
  report.seconds.query = clock.lap();
  if (!arguments.output.empty()) write_parts(arguments.output, report.result);
  report.seconds.write = clock.lap();
  report.provenance = provenance();
  report.threads = threads;
  report.seconds.total = clock.seconds();
  if (!arguments.common.json.empty()) write_text(arguments.common.json, to_json(report));
  tell(arguments.common, closing_line(report), [&] { print_report(report); });
  return code;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "Penetration depth of two closed triangle meshes: each connected volume of their intersection, with the distance "
      "of its two surfaces as a proven interval [lower, upper] and the deepest points.",
      "penetration_depth");
  PenetrationArguments arguments;
  add_arguments(app, arguments);
  return tool_main(app, argc, argv, [&arguments] { return run(arguments); });
}
