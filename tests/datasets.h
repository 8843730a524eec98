// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace meshbound::test {

/// The real mesh `relative` (such as "scan/igl_bunny.off"), looked for in $MESHBOUND_DATASETS, else in shared/datasets
/// beside the source tree, else in the fetcher's cache. Nothing when it is not on this machine: skip with a reason.
/// Needs the compile definition MESHBOUND_SOURCE_DIR.
inline std::optional<std::filesystem::path> dataset(const std::string& relative) {
  const std::filesystem::path source = MESHBOUND_SOURCE_DIR;
  const char* const named = std::getenv("MESHBOUND_DATASETS");
  const std::filesystem::path folders[] = {named != nullptr ? named : "", source / "../shared/datasets",
                                           source / "datasets/cache"};
  for (const std::filesystem::path& folder : folders)
    if (!folder.empty() && std::filesystem::exists(folder / relative)) return folder / relative;
  return std::nullopt;
}

/// The files of one folder of the real meshes ("cad"), found as above, in order of their names; none when it is not on
/// this machine.
inline std::vector<std::filesystem::path> datasets_in(const std::string& folder) {
  std::vector<std::filesystem::path> files;
  const auto found = dataset(folder);
  if (!found) return files;
  for (const auto& entry : std::filesystem::directory_iterator(*found))
    if (entry.is_regular_file()) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace meshbound::test
