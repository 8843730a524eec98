// SPDX-License-Identifier: MIT
#include "simplify/output_paths.h"

#include <string>
#include <vector>

#include "common/distinct_files.h"
#include "common/output.h"
#include "meshbound/error.h"

namespace meshbound::tools {

std::filesystem::path level_path(const SimplifyArguments& options, std::size_t index) {
  const std::filesystem::path out = options.output;
  const std::filesystem::path folder =
      options.output_dir.empty() ? out.parent_path() : std::filesystem::path(options.output_dir);
  return folder / (out.stem().string() + "_level_" + std::to_string(index) + out.extension().string());
}

std::filesystem::path level_certificate_path(const SimplifyArguments& options, std::size_t index) {
  const std::filesystem::path certificate = options.certificate;
  return certificate.parent_path() /
         (certificate.stem().string() + "_level_" + std::to_string(index) + certificate.extension().string());
}

void check_paths(const SimplifyArguments& options) {
  if (!options.output_dir.empty() && options.levels.empty())
    throw InvalidInput("--output-dir is the folder of --levels or of --batch, and OUT has its own: leave it out");
  std::vector<NamedPath> outputs = options.deviation.outputs();
  outputs.insert(outputs.end(),
                 {{"OUT", options.output}, {"--json", options.common.json}, {"--certificate", options.certificate}});
  for (std::size_t i = 0; i < options.levels.size(); ++i) {
    outputs.push_back({"--levels", level_path(options, i)});
    if (!options.certificate.empty()) outputs.push_back({"--certificate", level_certificate_path(options, i)});
  }
  require_distinct_files({{"IN", options.input}, {"--feature-edges", options.feature_edges}}, outputs);
  options.deviation.check();
  check_writable(options.common.json);
}

}  // namespace meshbound::tools
