// SPDX-License-Identifier: MIT
#include "deviation/deviation_outputs.h"

#include <algorithm>
#include <utility>

#include "common/distance_text.h"
#include "common/length.h"
#include "common/signals.h"
#include "deviation/deviation_image.h"
#include "deviation/heatmap_file.h"
#include "mesh/mesh_arrays.h"
#include "meshbound/bvh.h"
#include "meshbound/mesh_summary.h"

namespace meshbound::tools {
namespace {

/// Triangles in the view of a report for each of the two meshes, and for all levels together: some 2.5 MB each as text.
constexpr std::size_t max_display_triangles = 60'000;

/// Bytes of text of these at most, each: triangles that share no vertices take 6 MB, and the original has deviations
/// for each level. Three of them leave 5 MB of the 20 MB of a report for the page, its engine and the document.
constexpr std::size_t max_display_size = 5'000'000;

/// With more levels than this the view shows the result alone.
constexpr std::size_t max_display_levels = 24;

DeviationStatistics statistics_of(const TriangleMesh& mesh, const Bvh& other, const DeviationScale& scale,
                                  double max_distance, const DeviationOptions& options) {
  DeviationSampling sampling;
  sampling.scale = scale.end;
  sampling.max_distance = max_distance;
  return deviation_statistics(mesh, other, sampling, options);
}

/// Deviations of a mesh of which no point is further than `max_distance`.
std::vector<Bounds> at_most(std::vector<Bounds> deviations, double max_distance) {
  for (Bounds& deviation : deviations) deviation.upper = std::min(deviation.upper, max_distance);
  return deviations;
}

/// Deviations of the vertices of a mesh of which no point is further than `max_distance`. Those that no triangle has
/// are no points of it, and may be.
std::vector<Bounds> of_vertices(const TriangleMesh& mesh, const Bvh& other, double max_distance,
                                const DeviationOptions& options) {
  std::vector<Bounds> deviations = vertex_deviations(mesh, other, options);
  const std::vector<std::uint8_t> used = used_vertices(mesh);
  for (std::size_t v = 0; v < used.size(); ++v)
    if (used[v] != 0) deviations[v].upper = std::min(deviations[v].upper, max_distance);
  return deviations;
}

/// What a report shows of a mesh of which no point is further than `max_distance`.
DisplayMesh shown(const TriangleMesh& mesh, const std::vector<Bounds>& vertices, const Bvh& other, double max_distance,
                  const DisplayLimits& limits, const DeviationOptions& options) {
  DisplayMesh display = display_mesh(mesh, vertices, other, limits, options);
  display.deviations = at_most(std::move(display.deviations), max_distance);
  return display;
}

}  // namespace

ProvenMaxima proven_maxima(const Bounds& distance, const OneSidedDistance& original_to_result,
                           const OneSidedDistance* result_to_original) {
  ProvenMaxima maxima;
  maxima.of_original = original_to_result.bounds.upper;
  if (result_to_original == nullptr) return maxima;
  maxima.of_original = std::min(maxima.of_original, distance.upper);
  maxima.of_result = std::min(result_to_original->bounds.upper, distance.upper);
  return maxima;
}

DeviationSubject::DeviationSubject(const TriangleMesh& original_mesh, const TriangleMesh& result_mesh, double tolerance,
                                   const Bounds& distance, const OneSidedDistance& original_to_result,
                                   const OneSidedDistance* result_to_original)
    : original(&original_mesh),
      result(&result_mesh),
      maxima(proven_maxima(distance, original_to_result, result_to_original)),
      scale(scale_for(tolerance, distance, bounding_box_diagonal(original_mesh))) {
  const auto worst = worst_spot(distance, original_to_result, result_to_original);
  worst_is_on_original = !worst || worst->on_a;
}

/// Both trees and the deviations of the vertices of both meshes.
struct DeviationOutputs::Measured {
  std::pair<Bvh, Bvh> trees;
  std::vector<Bounds> original, result;

  Measured(const DeviationSubject& subject, const DeviationOptions& options)
      : trees(build_trees(*subject.original, *subject.result, {options.threads, options.stop})),
        original(of_vertices(*subject.original, trees.second, subject.maxima.of_original, options)),
        result(of_vertices(*subject.result, trees.first, subject.maxima.of_result, options)) {}
};

void DeviationOutputs::measure(const DeviationSubject& subject, const DeviationOptions& options) {
  const Measured measured(subject, options);
  report_.scale = subject.scale.end;
  report_.scale_meaning = subject.scale.meaning;
  report_.unit = request_.units;
  report_.a_to_b =
      statistics_of(*subject.original, measured.trees.second, subject.scale, subject.maxima.of_original, options);
  report_.b_to_a =
      statistics_of(*subject.result, measured.trees.first, subject.scale, subject.maxima.of_result, options);
  stage_heatmap(request_.heatmap, *subject.result, measured.result, subject,
                subject.result_name + ", coloured by its distance to " + subject.original_name);
  stage_heatmap(request_.original_heatmap, *subject.original, measured.original, subject,
                subject.original_name + ", coloured by its distance to " + subject.result_name);
  if (!request_.image.empty()) make_picture(subject, measured, options);
  if (!request_.report.empty()) make_scene(subject, measured, options);
}

AtomicFile& DeviationOutputs::add_file(const std::string& path) {
  return files_.emplace_back(path, AtomicFile::Stream::Staged, stop_at_signal());
}

void DeviationOutputs::stage_heatmap(const std::string& path, const TriangleMesh& mesh,
                                     const std::vector<Bounds>& deviations, const DeviationSubject& subject,
                                     const std::string& description) {
  if (path.empty()) return;
  AtomicFile& file = add_file(path);
  write_heatmap(file, mesh, deviations, subject.scale, description);
  file.complete();
}

void DeviationOutputs::make_picture(const DeviationSubject& subject, const Measured& measured,
                                    const DeviationOptions& options) {
  DeviationScene scene;
  scene.original = subject.original;
  scene.result = subject.result;
  scene.original_texture = subject.original_texture;
  scene.result_texture = subject.result_texture;
  scene.result_title = subject.result_name;
  const bool first = subject.worst_is_on_original;
  scene.coloured = first ? subject.original : subject.result;
  scene.other = first ? &measured.trees.second : &measured.trees.first;
  scene.max_deviation = first ? subject.maxima.of_original : subject.maxima.of_result;
  scene.coloured_title = "distance of " + (first ? subject.original_name : subject.result_name);
  scene.unit = request_.units;
  scene.scale = subject.scale;
  scene.up = request_.up.value_or(UpAxis::Z);
  png_ = deviation_image(scene, options).png();
}

void DeviationOutputs::make_scene(const DeviationSubject& subject, const Measured& measured,
                                  const DeviationOptions& options) {
  scene_.original_name = subject.original_name;
  scene_.result_name = subject.result_name;
  scene_.scale = subject.scale;
  scene_.up = request_.up.value_or(UpAxis::Z);
  scene_.unit = request_.units;
  scene_.measure_here = measure_here(subject.measurement, *subject.original, *subject.result);
  const std::size_t levels = subject.levels.size() <= max_display_levels ? subject.levels.size() : 0;
  DisplayLimits limits{max_display_triangles, max_display_size};
  const Bvh& tree_of_original = measured.trees.first;
  ReportLevel result;
  result.display = shown(*subject.result, measured.result, tree_of_original, subject.maxima.of_result, limits, options);
  limits.deviation_sets = 2 + levels;  // its own, those from the result and those from each level
  scene_.original =
      shown(*subject.original, measured.original, measured.trees.second, subject.maxima.of_original, limits, options);
  result.first = scene_.original.deviations;
  for (std::size_t i = 0; i < levels; ++i) {
    const auto& [mesh, maxima] = subject.levels[i];
    const Bvh tree(mesh, BvhOptions{options.threads, options.stop});
    ReportLevel& level = scene_.levels.emplace_back();
    level.display = shown(mesh, vertex_deviations(mesh, tree_of_original, options), tree_of_original, maxima.of_result,
                          {max_display_triangles / levels, max_display_size / levels}, options);
    level.first = at_most(display_deviations(scene_.original, tree, options), maxima.of_original);
  }
  scene_.levels.push_back(std::move(result));
}

void DeviationOutputs::stage(const std::string& document) {
  if (!request_.image.empty()) {
    AtomicFile& file = add_file(request_.image);
    file.write(png_);
    file.complete();
  }
  if (!request_.report.empty()) {
    AtomicFile& file = add_file(request_.report);
    write_report(file, document, scene_);
    file.complete();
  }
}

void DeviationOutputs::publish() {
  for (AtomicFile& file : files_) file.commit();
}

void print_deviation(const DeviationReport& report, const std::string& a_to_b, const std::string& b_to_a) {
  const std::string unit = report.unit.empty() ? "" : " " + report.unit;
  for (const auto& [name, found] : {std::pair(a_to_b, &report.a_to_b), std::pair(b_to_a, &report.b_to_a)})
    print_line("deviation", name + ": mean " + short_number(found->mean) + unit + ", RMS " +
                                short_number(found->root_mean_square) + unit + ", 95% of the area within " +
                                short_number(found->percentile_95) + unit + " (" + std::to_string(found->samples) +
                                " samples)");
}

}  // namespace meshbound::tools
