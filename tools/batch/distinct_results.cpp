// SPDX-License-Identifier: MIT
#include "batch/distinct_results.h"

#include <algorithm>

#include "common/distinct_files.h"
#include "common/signals.h"
#include "meshbound/error.h"

namespace meshbound::tools {
namespace {

namespace fs = std::filesystem;

NamedPath mesh_of(const Asset& asset) { return {"mesh " + asset.input.string() + " of --batch", asset.input}; }

std::vector<NamedPath> outputs_of(const BatchFiles& batch) {
  std::vector<NamedPath> outputs;
  for (const Asset& asset : batch.assets)
    outputs.push_back({"--output-dir for " + asset.input.string(), batch.output_dir / asset.name});
  for (const fs::path& report : batch.reports) outputs.push_back({"--output-dir", report});
  return outputs;
}

}  // namespace

void require_distinct_results(const BatchFiles& batch) {
  const std::vector<NamedPath> outputs = outputs_of(batch);
  DistinctFiles files;
  files.add_input({"--batch", batch.source});
  for (const Asset& asset : batch.assets) files.add_input(mesh_of(asset));
  // Only what is there can be replaced: without such an output no glTF need be read.
  const bool may_replace = std::any_of(
      outputs.begin(), outputs.end(), [&files](const NamedPath& output) { return files.replaces_a_file(output.path); });
  for (std::size_t i = 0; may_replace && i < batch.own_assets.size(); ++i) {
    if (interrupted()) throw Error("interrupted");
    std::error_code error;
    if (fs::is_regular_file(batch.own_assets[i].input, error)) files.add_files_beside(mesh_of(batch.own_assets[i]));
  }
  for (const NamedPath& output : outputs) files.add_output(output);
}

}  // namespace meshbound::tools
