// SPDX-License-Identifier: MIT
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "common/distinct_files.h"
#include "common/tool_main.h"
#include "deviation/camera.h"

namespace meshbound::tools {

/// The options that ask to see where two meshes differ.
struct DeviationRequest {
  std::string heatmap;           ///< file for the result in colours; empty, here and below: not wanted
  std::string original_heatmap;  ///< file for the original in colours
  std::string report;            ///< HTML file
  std::string image;             ///< PNG file
  std::string units;             ///< what a length is called, such as "mm"
  std::optional<UpAxis> up;      ///< of reports and pictures; none: z

  [[nodiscard]] bool has_any() const { return !outputs().empty(); }
  /// The files that are asked for, with the names of their options.
  [[nodiscard]] std::vector<NamedPath> outputs() const;
  /// Checks, before any work, that the files can be written and that no option is without use. Throws `InvalidInput`
  /// and `IoError`.
  void check() const;
};

/// Adds --report, --units and --up.
void add_report_options(CLI::App& app, DeviationRequest& request);

/// Adds --report, --units, --up, --heatmap, --heatmap-original and --image. `original` and the name after it are those
/// of the meshes in the help of the tool: "IN" and "OUT", "A" and "B".
void add_deviation_options(CLI::App& app, DeviationRequest& request, const std::string& original,
                           const std::string& result);

}  // namespace meshbound::tools
