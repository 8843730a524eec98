// SPDX-License-Identifier: MIT
#include "simplify/reproducer.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "common/output.h"
#include "common/standard_streams.h"

namespace meshbound::tools {

std::filesystem::path save_reproducer(const SimplifyArguments& arguments, const GatedOutput& rejected,
                                      const RejectedRun& run) {
  const bool has_name = !is_stream_path(arguments.output), has_file = !is_stream_path(arguments.input);
  const std::filesystem::path folder = (has_name ? arguments.output : "stdout") + ".reproducer",
                              input = arguments.input;
  const auto original = folder / ("original" + input.extension().string());
  const auto result = folder / ("rejected" + rejected.path().extension().string());
  std::filesystem::create_directories(folder);
  if (has_file) std::filesystem::copy_file(input, original, std::filesystem::copy_options::overwrite_existing);
  rejected.copy_rejected_to(result);
  nlohmann::json options = {{"schema", "meshbound/reproducer/1"},
                            {"version", MESHBOUND_VERSION},
                            {"original", has_file ? original.filename().string() : "-"},
                            {"rejected", result.filename().string()},
                            {"rejected_tolerance", run.rejected_tolerance},
                            {"distance", {{"lower", rejected.distance().bounds.lower}}},
                            {"tolerances", run.tolerances},
                            {"on_exceed", arguments.on_exceed},
                            {"driver", arguments.driver},
                            {"cost", arguments.cost},
                            {"effort", arguments.effort},
                            {"preserve_boundary", arguments.preserve_boundary},
                            {"prune", arguments.prune},
                            {"threads", arguments.common.threads}};
  if (arguments.target_faces) options["target_faces"] = *arguments.target_faces;
  if (arguments.feature_angle) options["feature_angle"] = *arguments.feature_angle;
  if (!arguments.line_tolerance.empty()) options["line_tolerance"] = arguments.line_tolerance;
  options["placement"] = arguments.placement;
  if (run.target_ratio) options["target_ratio"] = *run.target_ratio;
  if (std::isfinite(arguments.common.time_limit)) options["time_limit"] = arguments.common.time_limit;
  write_text(folder / "options.json", options.dump(2) + '\n');
  return folder;
}

}  // namespace meshbound::tools
