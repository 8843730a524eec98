// SPDX-License-Identifier: MIT
#include "decimation/decimation_run.h"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <numbers>
#include <utility>

#include "common/length.h"
#include "common/provenance.h"
#include "common/signals.h"
#include "common/standard_streams.h"
#include "decimation/decimation_text.h"
#include "decimation/drivers.h"
#include "decimation/measurement_fault.h"
#include "mesh/round_to_floats.h"
#include "mesh/texture_transform.h"
#include "mesh/writers.h"
#include "meshbound/error.h"
#include "meshbound/io.h"
#include "meshbound/mesh_summary.h"
#include "numeric/no_index.h"
#include "numeric/sort_unique.h"

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

/// Cuts that the second method of measuring may make in one direction, some seconds of work: at a tolerance below the
/// rounding of a file it goes on until doubles end.
constexpr std::uint64_t max_cuts_of_second_method = 1 << 20;

/// A share of the largest coordinate of a vertex: vertices that are nearer to each other may have the same position in
/// the working frame, the scaled coordinates in which a mesh is decimated.
constexpr double rounding_of_frame = 0x1p-50;

/// What of a level, or of the original, has moved too far in the texture or turned too much.
std::vector<Refuted> refuted_by(const GatedOutput& output) {
  std::vector<Refuted> refuted;
  if (const auto& texture = output.texture_deviation()) {
    for (const TextureWitness& w : texture->a_to_b.exceeding)
      refuted.push_back({w.from.triangle, w.nearest.triangle, w.coordinate});
    for (const TextureWitness& w : texture->b_to_a.exceeding)
      refuted.push_back({no_index, w.from.triangle, w.coordinate});
  }
  if (const auto& normals = output.normal_deviation())
    for (const FaceTurn& turn : normals->exceeding) refuted.push_back({turn.from.triangle, turn.nearest.triangle});
  return refuted;
}

/// Throws for an output that rounds the original so that its texture or its normals exceed their tolerances.
[[noreturn]] void refuse_rounding(const GatedOutput& output) {
  throw Error(output.path().string() +
              ": rounding coordinates to this format alone moves the texture or turns faces by more than their "
              "tolerance; use PLY or OBJ, or a larger tolerance; nothing was written");
}

bool carries_texture_coordinates(FileFormat format) { return format != FileFormat::Stl && format != FileFormat::Off; }

}  // namespace

int internal::undecided_measurements = 0;

DecimationRun::DecimationRun(const DecimationOptions& options)
    : clock_(options.common),
      shared_(options),
      measured_original_(original_.mesh, options.common.threads),
      threads_(options.common.threads) {
  (void)collapse_driver(options.driver, options.cost);  // throws before any work where there is none
}

void DecimationRun::read_original(MeshReport& report, bool with_checksum, const std::filesystem::path& output) {
  original_ = tools::read_original(shared_, output, with_checksum, clock_.stop_of_reading(), report);
  if (original_.stored) measured_original_.measure_in_tiles(*original_.stored, *shared_.workers);
  output_format_ = output.extension().string();
  output_carries_texture_ = carries_texture_coordinates(format_of(output));
}

void DecimationRun::add_tolerances(const std::string& flag, const std::vector<std::string>& texts) {
  for (const std::string& text : texts)
    tolerances_.push_back(parse_length(flag, text).in_model_units(original_.diagonal));
}

void DecimationRun::sort_tolerances() { sort_unique(tolerances_); }

void DecimationRun::choose_appearance(const std::string& kind) {
  if (shared_.texture_tolerance.empty()) {
    if (shared_.texture_size) throw InvalidInput("--texture-size goes with --texture-tolerance; leave it out");
    return;
  }
  texture_tolerance_ = parse_texture_tolerance(shared_.texture_tolerance, shared_.texture_size.has_value());
  if (!output_carries_texture_)
    throw InvalidInput("--texture-tolerance needs texture coordinates, which the format of the output, " +
                       output_format_ + ", does not carry; use .obj, .ply or .glb");
  if (original_.attributes.texture_coordinates.empty())
    throw InvalidInput("--texture-tolerance needs texture coordinates, and " + kind +
                       " of a format that carries them (OBJ, PLY, glTF): none were found in " +
                       as_typed(shared_.input));
  warn_of_other_coordinates();
  if (shared_.texture_size)
    texel_length_ =
        texel_length(textured_meshes(original_.mesh, original_.attributes, original_.mesh, original_.attributes)[0],
                     *shared_.texture_size * texture_scale(original_.attributes));
}

/// Further sets of texture coordinates come along, but nothing is measured of them.
void DecimationRun::warn_of_other_coordinates() const {
  std::string sets;
  for (const NamedAttribute& attribute : original_.attributes.named)
    if (attribute.name.starts_with("TEXCOORD_")) sets += (sets.empty() ? "" : ", ") + attribute.name;
  if (sets.empty()) return;
  const std::string warning =
      shared_.input + ": --texture-tolerance bounds the first set of texture coordinates only, and not " + sets;
  if (shared_.strict) throw InvalidInput(warning + "; leave out --strict to accept that");
  std::fprintf(stderr, "%s: %s\n", provenance().tool.c_str(), warning.c_str());
}

SimplifyOptions DecimationRun::decimation(const GatedOutput& output, double tolerance, ProgressBar& bar) const {
  SimplifyOptions options;
  options.tolerance = before_rounding(tolerance);
  options.driver = collapse_driver(shared_.driver, shared_.cost);
  options.preserve_boundary = shared_.preserve_boundary;
  if (shared_.feature_angle) options.feature_angle = *shared_.feature_angle / 180 * std::numbers::pi;
  if (!shared_.line_tolerance.empty())
    options.line_tolerance =
        parse_length("--line-tolerance", shared_.line_tolerance).in_model_units(original_.diagonal);
  options.feature_edges = original_.feature_edges;
  options.looks = original_.looks;
  options.keep_sides = original_.attributes.document || !original_.attributes.texture_coordinates.empty() ||
                       !original_.attributes.normals.empty();
  if (shared_.placement == "subset") options.placements = CollapsePlacements::Subset;
  options.normal_tolerance = shared_.normal_tolerance;
  if (bounds_texture()) guard_texture(texture_tolerance_of(tolerance), options);
  options.precision = rounds_to_floats(output) ? Precision::Single : Precision::Double;
  options.time_limit = clock_.seconds_left(simplify_share);
  options.threads = threads_;
  options.cancel = &interrupted();
  options.progress = bar.callback();
  return options;
}

/// Makes the decimation refuse collapses that move the texture too far.
void DecimationRun::guard_texture(double tolerance, SimplifyOptions& options) const {
  const CornerAttribute& from = original_.attributes.texture_coordinates;
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  for (const Triangle& index : from.index) {
    auto& corners = options.texture_coordinates.emplace_back();
    for (std::size_t k = 0; k < 3; ++k)
      corners[k] = index[k] == CornerAttribute::none ? Eigen::Vector2d(none, none) : from.values[index[k]].head<2>();
  }
  options.materials = original_.attributes.materials.index;
  options.texture_tolerance = tolerance;
}

double DecimationRun::before_rounding(double tolerance) const {
  return original_.rounding > 0 ? std::max(tolerance - original_.rounding, tolerance / 2) : tolerance;
}

/// Width of the interval that a distance with this tolerance is measured to, unless it was said.
double DecimationRun::narrow_enough(double tolerance) const {
  return std::max(default_error_bound * tolerance, min_error_bound * original_.diagonal);
}

DistanceOptions DecimationRun::measurement(double tolerance) const {
  DistanceOptions options;
  options.error_bound = shared_.error_bound.empty()
                            ? narrow_enough(tolerance)
                            : parse_length("--error-bound", shared_.error_bound).in_model_units(original_.diagonal);
  options.tolerance = tolerance;
  options.threads = threads_;
  options.cancel = &interrupted();
  return options;
}

DeviationSubject DecimationRun::deviation_subject(const GatedOutput& output, std::span<const GatedOutput> finer,
                                                  const TriangleMesh& result, DecidedBy how) const {
  const double tolerance = tolerances_.back();
  const HausdorffDistance& distance = output.distance();
  DeviationSubject subject(original_.mesh, result, tolerance, distance.bounds, distance.a_to_b, &distance.b_to_a);
  subject.original_name = "original";
  for (const GatedOutput& level : finer) subject.levels.push_back({level.written_mesh(), maxima_of(level.distance())});
  RepeatedMeasurement& repeated = subject.measurement;
  repeated.error_bound = output.narrowed_to() ? output.narrowed_to() : measurement(tolerance).error_bound;
  repeated.tolerance = tolerance;
  if (how == DecidedBy::SecondMethod || how == DecidedBy::SmallerLevel)
    repeated.obstacle = "The engine of this page cannot repeat how this was measured: " + explanation(how) + ".";
  return subject;
}

/// The original as files like `output` would hold it.
const TriangleMesh& DecimationRun::original_of_normals(const GatedOutput& output) {
  if (output.precision() == Precision::Double || original_.attributes.document)
    return original_.mesh;  // floats of nodes are exact
  if (!rounded_original_) rounded_original_ = rounded_for(output.path(), original_.mesh, shared_.write);
  return *rounded_original_;
}

void DecimationRun::set_requirements(GatedOutput& output, double tolerance) {
  if (original_lines_) output.require_lines(&*original_lines_);
  if (bounds_texture()) {
    const double of_texture = texture_tolerance_of(tolerance);
    output.require_texture(
        OriginalTexture{&original_.mesh, &original_.texture_as_read, of_texture, narrow_enough(of_texture)});
  }
  if (shared_.normal_tolerance)
    output.require_normals(OriginalNormals{&original_of_normals(output), *shared_.normal_tolerance});
}

DecidedBy DecimationRun::make_output(GatedOutput& output, double tolerance, const OutputSteps& steps,
                                     SimplifyReport::Seconds& seconds) {
  set_requirements(output, tolerance);
  for (;;) {
    const SimplifiedLevel& level = steps.make();
    end_if_interrupted();
    seconds.simplify += clock_.lap();
    const bool is_wrong = looks_wrong(output, level);
    seconds.certify += clock_.lap();
    if (is_wrong && takes_back(output)) continue;
    (void)writes(output, level);  // if this fails, `prove` falls back to a smaller output or the original
    seconds.write += clock_.lap();
    const DecidedBy how = prove(output, tolerance, steps);
    seconds.certify += clock_.lap();
    if (output.verdict() != Verdict::Within) {
      obstacle_ = obstacle_of(output, tolerance, how == DecidedBy::Original || level.ended_by == EndedBy::Rounding);
      return how;
    }
    if (!output.keeps_appearance()) {
      if (takes_back(output)) continue;
      const DecidedBy of_other = fall_back(output, steps.smaller, measurement(tolerance));
      if (output.keeps_appearance()) return of_other;
      refuse_rounding(output);
    }
    if (how == DecidedBy::Measurement && level.ended_by == EndedBy::Target) {
      narrow(output, tolerance);
      seconds.certify += clock_.lap();
    }
    const bool has_more_faces = steps.smaller != nullptr && output.summary().faces > steps.smaller->summary().faces;
    return has_more_faces ? fall_back(output, steps.smaller, measurement(tolerance)) : how;
  }
}

/// Measures the distance to 1% of itself: where a target ended the run, the tolerance may be far above it. Does not
/// where a width was asked for, or the time limit comes.
void DecimationRun::narrow(GatedOutput& output, double tolerance) {
  if (!shared_.error_bound.empty()) return;
  DistanceOptions options = measurement(tolerance);
  for (;;) {  // each time to 1% of the upper bound before, which is above the distance by less and less
    const Bounds& bounds = output.distance().bounds;
    options.error_bound = narrow_enough(bounds.upper);
    const bool is_narrow = bounds.upper - bounds.lower <= *options.error_bound;
    if (is_narrow || is_out_of_time() || !output.narrow(measured_original_, options)) return;
  }
}

/// Frames of nodes round by themselves (`original_.rounding`).
bool DecimationRun::rounds_to_floats(const GatedOutput& output) const {
  return original_.rounding == 0 && output.precision() == Precision::Single;
}

/// What to do where the floats of the output are too coarse.
std::string DecimationRun::without_floats() const {
  return std::string("use PLY, OFF or OBJ") + (shared_.write.single_precision ? ", without --single-precision" : "") +
         ", or move the mesh to the origin";
}

/// The largest absolute value of a coordinate of the original.
double DecimationRun::largest_coordinate() const {
  Eigen::AlignedBox3d box;
  if (original_.stored)
    original_.stored->for_each_vertex([&](std::uint32_t, const Eigen::Vector3d& p) { box.extend(p); });
  else
    box = used_bounding_box(original_.mesh);
  return std::max(box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff());
}

std::string DecimationRun::rounding_reason(const GatedOutput& output, double tolerance) const {
  const double largest = largest_coordinate();
  constexpr double sufficient = 16;  // with doubles a run collapses edges from 10 times the rounding of its frame on
  const bool floats_are_to_blame = rounds_to_floats(output) && tolerance > sufficient * rounding_of_frame * largest;
  return "the tolerance is below the rounding of the coordinates" +
         (floats_are_to_blame ? " to the floats of " + output_format_ + ": nothing collapsed; " + without_floats()
                              : ": nothing collapsed");
}

/// What keeps an output from its tolerances where rounding to its format alone exceeds them; else empty.
std::string DecimationRun::obstacle_of(const GatedOutput& output, double tolerance, bool is_original) const {
  const std::string is_small = " is smaller than the rounding of the output format", advice = without_floats();
  if (verdict_of(output.distance().bounds, tolerance) != Verdict::Within)
    return is_original ? "the tolerance" + is_small + "; " + advice : "";
  if (!original_lines_) return "";
  const bool has_floats = output.precision() == Precision::Single;
  double moved = 0;  // vertices of lines
  for (const Edge& line : lines_) {
    for (const std::uint32_t v : line) {
      const Eigen::Vector3d& p = original_.mesh.vertices[v];
      moved = std::max({moved, rounding_of_frame * p.cwiseAbs().maxCoeff(),
                        has_floats ? (rounded_to_float(p) - p).stableNorm() : 0});
    }
  }
  if (moved <= std::min(original_lines_->tolerance, tolerance)) return "";
  constexpr double more = 1.01;  // so that a measurement of it can be decided
  const std::string which = original_lines_->tolerance < tolerance ? "--line-tolerance" : "the tolerance",
                    enough = "; raise it to " + short_number(more * moved);
  return has_floats ? which + is_small + enough + ", or " + advice
                    : which + " is smaller than the rounding of the coordinates" + enough;
}

double DecimationRun::max_rounding(const GatedOutput& output) const {
  // Half a step of the floats on three axes: less than a step.
  constexpr double step_of_floats = 0x1p-23, smallest_float = 0x1p-149;
  return original_.rounding + (rounds_to_floats(output) ? step_of_floats * largest_coordinate() + smallest_float : 0);
}

std::string DecimationRun::obstacle_of_original(GatedOutput& output, double tolerance) {
  set_requirements(output, tolerance);
  (void)fall_back(output, nullptr, measurement(tolerance));
  end_if_interrupted();
  if (output.verdict() != Verdict::Within) return obstacle_of(output, tolerance, true);
  if (!output.keeps_appearance()) refuse_rounding(output);
  return "";
}

/// Whether a level moves the texture too far or turns faces too much. What is seen before it is written need not be
/// written again. Where rounding alone is too much for the tolerance of the surface, nothing can be taken back.
bool DecimationRun::looks_wrong(GatedOutput& output, const SimplifiedLevel& level) {
  if (!scene_ || !bounds_appearance() || level.ended_by == EndedBy::Rounding) return false;
  look_at(output, level);
  return !output.keeps_appearance();
}

/// Undoes what has led to a texture that has moved too far or to faces that have turned too much. False if nothing was
/// undone, or not in time.
bool DecimationRun::takes_back(const GatedOutput& output) {
  end_if_interrupted();
  return !is_out_of_time() && scene_->take_back(refuted_by(output));
}

/// Measures how far texture and normals of a level have changed, as far as the output requires it; leaves off at the
/// time limit.
void DecimationRun::look_at(GatedOutput& output, const SimplifiedLevel& level) {
  try {
    MeshAttributes visible;
    if (output.required_texture()) {
      visible.texture_coordinates = original_.attributes.texture_coordinates;
      visible.texture_precision = original_.attributes.texture_precision;
      visible.materials = original_.attributes.materials;
    }
    visible.document = original_.attributes.document;
    visible.part = original_.attributes.part;
    MeshAttributes attributes;
    if (!visible.empty()) attributes = transferred_attributes(original_.mesh, visible, level);
    MeshFile file;
    file.mesh = placed_as_written(level, attributes).mesh;
    file.attributes = std::move(attributes);
    output.look_at(file, threads());
  } catch (const Stopped&) {  // the file that is written next is not measured either
  }
}

/// False when the time limit came first.
bool DecimationRun::writes(GatedOutput& output, const SimplifiedLevel& level) const {
  try {
    const MeshAttributes attributes = original_.attributes.empty()
                                          ? MeshAttributes()
                                          : transferred_attributes(original_.mesh, original_.attributes, level);
    const SimplifiedLevel placed = placed_as_written(level, attributes);
    output.write(placed.mesh, placed.lines, attributes, level.turned_faces);
    return true;
  } catch (const Stopped&) {
    return false;
  }
}

/// Measures what was written; true when the verdict is known.
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

DecidedBy DecimationRun::prove(GatedOutput& output, double tolerance, const OutputSteps& steps) {
  DistanceOptions options = measurement(tolerance);
  if (!is_out_of_time() && decides(output, options)) return DecidedBy::Measurement;
  DistanceOptions second = options;
  second.method = Method::CrossCulling;
  second.budget.subdivisions = max_cuts_of_second_method;
  if (!is_out_of_time() && decides(output, second)) return DecidedBy::SecondMethod;
  if (!is_out_of_time() && writes(output, steps.redo(smaller_tolerance * tolerance)) && !is_out_of_time() &&
      decides(output, options))
    return DecidedBy::SmallerTolerance;
  end_if_interrupted();
  return fall_back(output, steps.smaller, options);
}

DecidedBy DecimationRun::fall_back(GatedOutput& output, const GatedOutput* smaller, const DistanceOptions& options) {
  output.fall_back(smaller, measured_original_, lines_, original_.attributes, options);
  return smaller != nullptr ? DecidedBy::SmallerLevel : DecidedBy::Original;
}

void DecimationRun::set_lines(std::vector<Edge> lines) {
  lines_ = std::move(lines);
  if (lines_.empty()) return;
  const double tolerance =
      shared_.line_tolerance.empty()
          ? std::numeric_limits<double>::infinity()  // that of the mesh
          : parse_length("--line-tolerance", shared_.line_tolerance).in_model_units(original_.diagonal);
  original_lines_.emplace(OriginalLines{Bvh(line_mesh(original_.mesh, lines_), BvhOptions{shared_.common.threads}),
                                        tolerance, original_.rounding});
}

std::optional<LineReport> DecimationRun::line_report(const GatedOutput& output, double tolerance) const {
  if (!original_lines_ || !output.line_distance()) return std::nullopt;
  return LineReport{std::min(original_lines_->tolerance, tolerance), lines_.size(), output.line_edges(),
                    *output.line_distance()};
}

std::optional<TextureReport> DecimationRun::texture_report(const GatedOutput& output) const {
  if (!output.required_texture() || !output.texture_deviation()) return std::nullopt;
  return TextureReport{*output.texture_deviation(), output.required_texture()->tolerance, shared_.texture_size,
                       texel_length_};
}

std::optional<NormalReport> DecimationRun::normal_report(const GatedOutput& output) const {
  if (!shared_.normal_tolerance || !output.normal_deviation()) return std::nullopt;
  return NormalReport{*output.normal_deviation(), *shared_.normal_tolerance};
}

void DecimationRun::end_if_interrupted() const {
  if (interrupted()) throw Error("interrupted before the result was proven; nothing was written");
}

}  // namespace meshbound::tools
