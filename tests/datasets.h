// SPDX-License-Identifier: MIT
#pragma once
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

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

}  // namespace meshbound::test
