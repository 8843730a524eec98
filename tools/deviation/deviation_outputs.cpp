// SPDX-License-Identifier: MIT
#include "deviation/deviation_outputs.h"

#include <utility>

#include "common/distance_text.h"
#include "common/length.h"
#include "deviation/deviation_image.h"
#include "deviation/heatmap_file.h"
#include "meshbound/bvh.h"

namespace meshbound::tools {
namespace {

/// Triangles in the view of a report for each of the two meshes, and for all levels together: some 2.5 MB each as text,
/// 7 MB for triangles that share no vertices.
constexpr std::size_t max_display_triangles = 60'000;

/// With more levels than this the view shows the result alone.
constexpr std::size_t max_display_levels = 24;

DeviationStatistics statistics_of(const TriangleMesh& mesh, const Bvh& other, const DeviationScale& scale,
                                  const DeviationOptions& options) {
  DeviationSampling sampling;
  sampling.scale = scale.end;
  return deviation_statistics(mesh, other, sampling, options);
}

}  // namespace

/// Both trees and the deviations of the vertices of both meshes.
struct DeviationOutputs::Measured {
  std::pair<Bvh, Bvh> trees;
  std::vector<Bounds> original, result;

  Measured(const DeviationSubject& subject, const DeviationOptions& options)
      : trees(build_trees(*subject.original, *subject.result, {options.threads, options.stop})),
        original(vertex_deviations(*subject.original, trees.second, options)),
        result(vertex_deviations(*subject.result, trees.first, options)) {}
};

void DeviationOutputs::measure(const DeviationSubject& subject, const DeviationOptions& options) {
  const Measured measured(subject, options);
  report_.scale = subject.scale.end;
  report_.scale_meaning = subject.scale.meaning;
  report_.unit = request_.units;
  report_.a_to_b = statistics_of(*subject.original, measured.trees.second, subject.scale, options);
  report_.b_to_a = statistics_of(*subject.result, measured.trees.first, subject.scale, options);
  stage(request_.heatmap, *subject.result, measured.result, subject,
        subject.result_name + ", coloured by its distance to " + subject.original_name);
  stage(request_.original_heatmap, *subject.original, measured.original, subject,
        subject.original_name + ", coloured by its distance to " + subject.result_name);
  if (!request_.image.empty()) make_picture(subject, measured, options);
  if (!request_.report.empty()) make_scene(subject, measured, options);
}

void DeviationOutputs::stage(const std::string& path, const TriangleMesh& mesh, const std::vector<Bounds>& deviations,
                             const DeviationSubject& subject, const std::string& description) {
  if (path.empty()) return;
  AtomicFile& file = heatmaps_.emplace_back(path, AtomicFile::Stream::Staged);
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
  scene_.original =
      display_mesh(*subject.original, measured.original, measured.trees.second, max_display_triangles, options);
  if (subject.levels.size() <= max_display_levels) {
    for (const TriangleMesh& mesh : subject.levels) {
      const Bvh tree(mesh, BvhOptions{options.threads, options.stop});
      ReportLevel& level = scene_.levels.emplace_back();
      level.display = display_mesh(mesh, vertex_deviations(mesh, measured.trees.first, options), measured.trees.first,
                                   max_display_triangles / subject.levels.size(), options);
      level.first = vertex_deviations(scene_.original.mesh, tree, options);
    }
  }
  ReportLevel& result = scene_.levels.emplace_back();
  result.display = display_mesh(*subject.result, measured.result, measured.trees.first, max_display_triangles, options);
  result.first = scene_.original.deviations;
}

void DeviationOutputs::write(const std::string& document) {
  for (AtomicFile& file : heatmaps_) file.commit();
  if (!request_.image.empty()) {
    AtomicFile file(request_.image);
    file.write(png_);
    file.commit();
  }
  if (!request_.report.empty()) {
    AtomicFile file(request_.report);
    write_report(file, document, scene_);
    file.commit();
  }
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
