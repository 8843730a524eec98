// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "deviation/camera.h"
#include "deviation/deviation_scale.h"
#include "deviation/display_mesh.h"
#include "deviation/measure_here.h"
#include "mesh/atomic_file.h"

namespace meshbound::tools {

/// A result in a report: the final one or one of the levels.
struct ReportLevel {
  DisplayMesh display;
  std::vector<Bounds> first;  ///< deviations of the vertices of `ReportScene::original` from this level
};

/// The meshes and the scale that the view of a report shows.
struct ReportScene {
  std::string original_name;  ///< such as "the original"
  std::string result_name;    ///< such as "the result"
  DisplayMesh original;
  std::vector<ReportLevel> levels;  ///< from the finest on, the result last
  DeviationScale scale;
  UpAxis up = UpAxis::Z;
  std::string unit;  ///< of lengths, may be empty
  MeasureHere measure_here;
};

/// Throws `InvalidInput`, naming `option`, in a build without the page of a report.
void require_report_page(const std::string& option);

/// Writes a report: one HTML file that needs no network. `document` is what `--json` writes. The caller commits the
/// file. Throws as `AtomicFile`, and as `require_report_page`.
void write_report(AtomicFile& file, const std::string& document, const ReportScene& scene);

}  // namespace meshbound::tools
