// SPDX-License-Identifier: MIT
#include "decimation/decimation_run.h"

#include <omp.h>

#include <algorithm>
#include <cstdio>
#include <limits>
#include <numbers>

#include "common/distance_text.h"
#include "common/length.h"
#include "common/mesh_input.h"
#include "common/signals.h"
#include "decimation/drivers.h"
#include "decimation/dropped_attributes.h"
#include "decimation/edge_file.h"
#include "decimation/measurement_fault.h"
#include "meshbound/error.h"
#include "meshbound/io.h"

namespace meshbound::tools {
namespace {

/// Share of the time limit that decimation may use; the rest is for the proof of what came out.
constexpr double simplify_share = 0.7;

/// Width of the measured interval, as a share of the tolerance; not below a share of the original's diagonal, where
/// rounding comes near.
constexpr double default_error_bound = 0.01;
constexpr double min_error_bound = 1e-9;

/// Share of a tolerance for which a result is made again where the distance of the first is too near to the tolerance
/// for any measurement.
constexpr double smaller_tolerance = 0.99;

}  // namespace

int internal::undecided_measurements = 0;

DecimationRun::DecimationRun(const DecimationOptions& options)
    : interrupted_(interrupted()),
      shared_(options),
      measured_original_(original_, options.common.threads),
      threads_(options.common.threads) {
  (void)collapse_driver(options.driver, options.cost);  // throws before any work where there is none
}

void DecimationRun::read_original(MeshReport& report, bool with_checksum, const std::filesystem::path& output) {
  const FileFormat format = format_of(output);
  const bool carries = !shared_.drop_attributes && carries_attributes(format);
  const StopToken stop = stop_of_reading(shared_.common, watch_);
  if (shared_.workers != nullptr) {
    stored_original_ = read_stored_input(shared_.input, with_checksum, report, stop, *shared_.workers);
    measured_original_.measure_in_tiles(*stored_original_, *shared_.workers);
  } else {
    original_ = read_input(shared_.input, with_checksum, report, stop, carries ? &attributes_ : nullptr);
    validate(original_);
  }
  if (carries) attributes_ = carried_by(format, std::move(attributes_), *report.dropped);
  if (shared_.strict && *report.dropped != DroppedAttributes{})
    throw InvalidInput(shared_.input + ": " + output.string() + " would not carry " + listed(*report.dropped) +
                       "; choose another format, or leave out --strict");
  if (!attributes_.empty()) feature_edges_ = seams(original_, attributes_);
  if (!shared_.feature_edges.empty()) {
    const std::vector<Edge> given = read_edges(shared_.feature_edges, original_.vertices.size(), stop);
    feature_edges_.insert(feature_edges_.end(), given.begin(), given.end());
  }
  rounding_ = placement_rounding(original_, attributes_);
  diagonal_ = report.summary.bbox_diagonal;
}

void DecimationRun::add_tolerances(const std::string& flag, const std::vector<std::string>& texts) {
  for (const std::string& text : texts) tolerances_.push_back(parse_length(flag, text).in_model_units(diagonal_));
}

void DecimationRun::sort_tolerances() {
  std::sort(tolerances_.begin(), tolerances_.end());
  tolerances_.erase(std::unique(tolerances_.begin(), tolerances_.end()), tolerances_.end());
}

SimplifyOptions DecimationRun::decimation(const GatedOutput& output, ProgressBar& bar) const {
  SimplifyOptions options;
  options.driver = collapse_driver(shared_.driver, shared_.cost);
  options.preserve_boundary = shared_.preserve_boundary;
  if (shared_.feature_angle) options.feature_angle = *shared_.feature_angle / 180 * std::numbers::pi;
  if (!shared_.line_tolerance.empty())
    options.line_tolerance = parse_length("--line-tolerance", shared_.line_tolerance).in_model_units(diagonal_);
  options.feature_edges = feature_edges_;
  if (shared_.placement == "subset") options.placements = CollapsePlacements::Subset;
  // Frames of nodes round by themselves (`rounding_`).
  options.precision = rounding_ > 0 ? Precision::Double : output.precision();
  options.time_limit = remaining(simplify_share);
  options.threads = threads_;
  options.cancel = &interrupted_;
  options.progress = [&bar](double fraction) { bar.show(fraction); };
  return options;
}

double DecimationRun::before_rounding(double tolerance) const {
  return rounding_ > 0 ? std::max(tolerance - rounding_, tolerance / 2) : tolerance;
}

DistanceOptions DecimationRun::measurement(double tolerance) const {
  DistanceOptions options;
  options.error_bound = shared_.error_bound.empty()
                            ? std::max(default_error_bound * tolerance, min_error_bound * diagonal_)
                            : parse_length("--error-bound", shared_.error_bound).in_model_units(diagonal_);
  options.tolerance = tolerance;
  options.threads = threads_;
  options.cancel = &interrupted_;
  return options;
}

RepeatedMeasurement DecimationRun::repeated(double tolerance, DecidedBy how) const {
  RepeatedMeasurement repeated;
  repeated.error_bound = measurement(tolerance).error_bound;
  repeated.tolerance = tolerance;
  if (how == DecidedBy::SecondMethod || how == DecidedBy::SmallerLevel)
    repeated.obstacle = "The engine of this page cannot repeat how this was measured: " + explanation(how) + ".";
  return repeated;
}

double DecimationRun::remaining(double share) const {
  return shared_.common.has_time_limit ? std::max(0.0, share * shared_.common.time_limit - watch_.seconds())
                                       : std::numeric_limits<double>::infinity();
}

void DecimationRun::look_at(GatedOutput& output, const SimplifiedLevel& level) {
  try {
    MeshAttributes visible;
    if (output.requires_texture()) {
      visible.texture_coordinates = attributes_.texture_coordinates;
      visible.texture_precision = attributes_.texture_precision;
      visible.materials = attributes_.materials;
    }
    visible.document = attributes_.document;
    visible.part = attributes_.part;
    MeshAttributes attributes;
    if (!visible.empty()) attributes = transferred_attributes(original_, visible, level);
    MeshFile file;
    file.mesh = placed_as_written(level, attributes).mesh;
    file.attributes = std::move(attributes);
    output.look_at(measured_original_, file, threads());
  } catch (const Stopped&) {  // the file that is written next is not measured either
  }
}

bool DecimationRun::writes(GatedOutput& output, const SimplifiedLevel& level) const {
  try {
    const MeshAttributes attributes =
        attributes_.empty() ? MeshAttributes() : transferred_attributes(original_, attributes_, level);
    const SimplifiedLevel placed = placed_as_written(level, attributes);
    output.write(placed.mesh, placed.lines, attributes);
    return true;
  } catch (const Stopped&) {
    return false;
  }
}

bool DecimationRun::decides(GatedOutput& output, const DistanceOptions& options) {
  try {
    output.measure(measured_original_, options);
  } catch (const Stopped&) {
    return false;
  }
  if (internal::undecided_measurements > 0) {
    --internal::undecided_measurements;
    return false;
  }
  return output.verdict() != Verdict::Undecided;
}

DecidedBy DecimationRun::prove(GatedOutput& output, double tolerance, const GatedOutput* smaller, const Redo& redo) {
  DistanceOptions options = measurement(tolerance);
  if (!is_out_of_time() && decides(output, options)) return DecidedBy::Measurement;
  options.method = Method::CrossCulling;
  if (!is_out_of_time() && decides(output, options)) return DecidedBy::SecondMethod;
  options.method = Method::CellWalking;
  if (!is_out_of_time() && writes(output, redo(smaller_tolerance * tolerance)) && !is_out_of_time() &&
      decides(output, options))
    return DecidedBy::SmallerTolerance;
  if (interrupted_) throw Error("interrupted before the result was proven; nothing was written");
  return fall_back(output, smaller, options);
}

DecidedBy DecimationRun::fall_back(GatedOutput& output, const GatedOutput* smaller, const DistanceOptions& options) {
  output.fall_back(smaller, measured_original_, lines_, attributes_, options);
  return smaller != nullptr ? DecidedBy::SmallerLevel : DecidedBy::Original;
}

void DecimationRun::set_lines(std::vector<Edge> lines) {
  lines_ = std::move(lines);
  if (lines_.empty()) return;
  const double tolerance = shared_.line_tolerance.empty()
                               ? std::numeric_limits<double>::infinity()  // that of the mesh
                               : parse_length("--line-tolerance", shared_.line_tolerance).in_model_units(diagonal_);
  original_lines_.emplace(
      OriginalLines{Bvh(line_mesh(original_, lines_), BvhOptions{shared_.common.threads}), tolerance, rounding_});
}

std::optional<LineReport> DecimationRun::line_report(const GatedOutput& output, double tolerance) const {
  if (!original_lines_ || !output.line_distance()) return std::nullopt;
  return LineReport{std::min(original_lines_->tolerance, tolerance), lines_.size(), output.line_edges(),
                    *output.line_distance()};
}

int DecimationRun::threads() const { return threads_ > 0 ? threads_ : omp_get_max_threads(); }

void print_dropped(const MeshReport& original) {
  if (original.dropped && *original.dropped != DroppedAttributes{})
    std::printf("dropped: %s\n", listed(*original.dropped).c_str());
  if (original.rest_pose_parts > 0)
    std::printf("rest pose: %zu parts have a skin or morph targets, and the bound is of how they are without these\n",
                original.rest_pose_parts);
}

std::string explanation(DecidedBy how) {
  switch (how) {
    case DecidedBy::Measurement:
      return "";
    case DecidedBy::SecondMethod:
      return "the measurement was undecided; a second method decided it";
    case DecidedBy::SmallerTolerance:
      return "the distance of the first result could not be decided: made again for 99% of the tolerance";
    case DecidedBy::SmallerLevel:
      return "no result for this tolerance could be decided or has fewer faces: it is that of the next smaller one";
    case DecidedBy::Original:
      break;
  }
  return "no result for this tolerance could be decided: it is the original";
}

void print_locked(std::size_t vertices, const MeshSummary& original) {
  if (vertices == 0) return;
  print_line("locked", std::to_string(vertices) + " of " + std::to_string(original.vertices) +
                           " vertices: they stay where they are, for edges");
}

void print_lines(const std::optional<LineReport>& lines, double diagonal) {
  if (!lines) return;
  print_line("lines", std::to_string(lines->original_edges) + " -> " + std::to_string(lines->edges) +
                          " edges, tolerance " + both_units(lines->tolerance, diagonal));
  print_line("", "distance " + interval(lines->distance.bounds));
}

void print_seconds(const SimplifyReport::Seconds& seconds, int threads) {
  print_line("seconds", "read " + rounded_seconds(seconds.read) + ", simplify " + rounded_seconds(seconds.simplify) +
                            ", write " + rounded_seconds(seconds.write) + ", certify " +
                            rounded_seconds(seconds.certify) + ", total " + rounded_seconds(seconds.total) +
                            thread_count(threads));
}

}  // namespace meshbound::tools
