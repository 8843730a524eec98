// SPDX-License-Identifier: MIT
#pragma once
#include <deque>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "deviation/deviation_request.h"
#include "deviation/deviation_scale.h"
#include "deviation/report_file.h"
#include "mesh/atomic_file.h"
#include "meshbound/attributes.h"
#include "meshbound/bounds.h"
#include "meshbound/deviation_map.h"
#include "meshbound/distance.h"
#include "meshbound/report.h"
#include "meshbound/triangle_mesh.h"

namespace meshbound::tools {

/// Proven upper bounds of the one-sided distances between an original and a result, model units; infinite where nothing
/// is known. No deviation that is shown exceeds them, however its point was rounded.
struct ProvenMaxima {
  double of_original = std::numeric_limits<double>::infinity();  ///< of points of the original from the result
  double of_result = std::numeric_limits<double>::infinity();    ///< of points of the result from the original
};

/// From the bounds of both directions, of which the second may be null. Only with both does `distance` bound both.
[[nodiscard]] ProvenMaxima proven_maxima(const Bounds& distance, const OneSidedDistance& original_to_result,
                                         const OneSidedDistance* result_to_original);

[[nodiscard]] inline ProvenMaxima maxima_of(const HausdorffDistance& distance) {
  return proven_maxima(distance.bounds, distance.a_to_b, &distance.b_to_a);
}

/// A result that is shown beside the one that a `DeviationSubject` is about.
struct ShownLevel {
  TriangleMesh mesh;
  ProvenMaxima maxima;
};

/// The meshes whose deviation is shown; all must outlive the call that gets them.
struct DeviationSubject {
  /// For these bounds of their distance, of which the last may be null. The scale ends at `tolerance` if that is above
  /// 0.
  DeviationSubject(const TriangleMesh& original, const TriangleMesh& result, double tolerance, const Bounds& distance,
                   const OneSidedDistance& original_to_result, const OneSidedDistance* result_to_original);

  const TriangleMesh *original, *result;
  /// Their texture coordinates, for the picture; null: not shown.
  const CornerAttribute *original_texture = nullptr, *result_texture = nullptr;
  std::string original_name, result_name;  ///< such as "original", "simplified"
  std::vector<ShownLevel> levels;          ///< finer results than `result`, from the finest on
  ProvenMaxima maxima;                     ///< of `original` and `result`
  DeviationScale scale;
  RepeatedMeasurement measurement;   ///< of the distance between `original` and `result`
  bool worst_is_on_original = true;  ///< else on `result`; the picture shows that mesh in colours
};

/// Makes everything that a `DeviationRequest` asks for: `measure` does the work, `stage` writes the files under no
/// name, `publish` makes them visible.
class DeviationOutputs {
 public:
  /// `request` must outlive this.
  explicit DeviationOutputs(const DeviationRequest& request) : request_(request) {}

  /// Measures and draws, and writes the coloured meshes under no name. Throws `Stopped` as the options say,
  /// `IoError` when a file cannot be written.
  void measure(const DeviationSubject& subject, const DeviationOptions& options);
  /// What `measure` found.
  [[nodiscard]] const DeviationReport& report() const { return report_; }
  /// Writes the picture and the report under no name. `document` is what `--json` writes. Throws `IoError`. Call once,
  /// after `measure`.
  void stage(const std::string& document);
  /// Makes the files visible. Call once, after `stage`. Throws `IoError`, and `Interrupted` where a device or FIFO is
  /// waited for.
  void publish();

 private:
  struct Measured;
  AtomicFile& add_file(const std::string& path);
  void stage_heatmap(const std::string& path, const TriangleMesh& mesh, const std::vector<Bounds>& deviations,
                     const DeviationSubject& subject, const std::string& description);
  void make_picture(const DeviationSubject& subject, const Measured& measured, const DeviationOptions& options);
  void make_scene(const DeviationSubject& subject, const Measured& measured, const DeviationOptions& options);

  const DeviationRequest& request_;
  DeviationReport report_;
  std::deque<AtomicFile> files_;
  std::string png_;
  ReportScene scene_;
};

/// Lines on stdout with the statistics of both directions.
void print_deviation(const DeviationReport& report, const std::string& a_to_b, const std::string& b_to_a);

}  // namespace meshbound::tools
