// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <filesystem>
#include <map>
#include <string>

#include "batch/record.h"

namespace meshbound::tools {

/// Number of assets by how they ended.
struct BatchCounts {
  std::size_t within = 0, exceeds = 0, undecided = 0, failed = 0;

  [[nodiscard]] std::size_t all() const { return within + exceeds + undecided + failed; }
};

[[nodiscard]] BatchCounts count_by_status(const std::map<std::string, AssetRecord>& records);

/// Writes batch.csv (a row for each asset, lengths in model units) and batch.html (one page, no other file needed) into
/// the folder. Throws `IoError`.
void write_tables(const std::filesystem::path& folder, const std::map<std::string, AssetRecord>& records);

}  // namespace meshbound::tools
