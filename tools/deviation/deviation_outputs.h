// SPDX-License-Identifier: MIT
#pragma once
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "deviation/deviation_request.h"
#include "deviation/deviation_scale.h"
#include "deviation/report_file.h"
#include "mesh/atomic_file.h"
#include "meshbound/attributes.h"
#include "meshbound/deviation_map.h"
#include "meshbound/report.h"
#include "meshbound/triangle_mesh.h"

namespace meshbound::tools {

/// The meshes whose deviation is shown; all must outlive the call that gets them.
struct DeviationSubject {
  const TriangleMesh* original = nullptr;
  const TriangleMesh* result = nullptr;
  /// Their texture coordinates, for the picture; null: not shown.
  const CornerAttribute *original_texture = nullptr, *result_texture = nullptr;
  std::string original_name, result_name;  ///< such as "original", "simplified"
  std::vector<TriangleMesh> levels;        ///< finer results than `result`, from the finest on
  DeviationScale scale;
  RepeatedMeasurement measurement;   ///< of the distance between `original` and `result`
  bool worst_is_on_original = true;  ///< the mesh that the picture shows in colours: where the worst spot is
};

/// Makes everything that a `DeviationRequest` asks for: `measure` does the work, `write` makes the files visible.
class DeviationOutputs {
 public:
  /// `request` must outlive this.
  explicit DeviationOutputs(const DeviationRequest& request) : request_(request) {}

  /// Measures and draws, and writes the coloured meshes under temporary names. Throws `Stopped` as the options say,
  /// `IoError` when a file cannot be written.
  void measure(const DeviationSubject& subject, const DeviationOptions& options);
  /// What `measure` found.
  [[nodiscard]] const DeviationReport& report() const { return report_; }
  /// Makes the files visible. `document` is what `--json` writes. Throws `IoError`. Call once, after `measure`.
  void write(const std::string& document);

 private:
  struct Measured;
  void stage(const std::string& path, const TriangleMesh& mesh, const std::vector<Bounds>& deviations,
             const DeviationSubject& subject, const std::string& description);
  void make_picture(const DeviationSubject& subject, const Measured& measured, const DeviationOptions& options);
  void make_scene(const DeviationSubject& subject, const Measured& measured, const DeviationOptions& options);

  const DeviationRequest& request_;
  DeviationReport report_;
  std::deque<AtomicFile> heatmaps_;
  std::string png_;
  ReportScene scene_;
};

/// Lines on stdout with the statistics of both directions.
void print_deviation(const DeviationReport& report, const std::string& a_to_b, const std::string& b_to_a);

}  // namespace meshbound::tools
