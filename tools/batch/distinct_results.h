// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "batch/assets.h"

namespace meshbound::tools {

/// What a batch reads and writes.
struct BatchFiles {
  std::string source;                          ///< the folder, or the list of meshes
  const std::vector<Asset>& assets;            ///< of all shards
  const std::vector<Asset>& own_assets;        ///< of this shard
  std::filesystem::path output_dir;            ///< of the results
  std::vector<std::filesystem::path> reports;  ///< that are written beside the results
};

/// Throws `InvalidInput`, one line, when a result or a report would replace a mesh of the batch, its list, a file that
/// a glTF is read together with, or another result, as `DistinctFiles` compares them. Results of earlier runs may be
/// replaced. The glTF of other shards are not read: their own shards compare the files beside them with all results.
void require_distinct_results(const BatchFiles& batch);

}  // namespace meshbound::tools
