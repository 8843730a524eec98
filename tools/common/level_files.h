// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <vector>

namespace meshbound::tools {

/// The files of an earlier run of lod_chain that `chain`, its chain.json, names and that are still as it left them:
/// beside `chain`, called lod_<number>.<format>, regular, writable, with the checksum of the document. Nothing where
/// `chain` is missing or no document of ours; files of versions that kept no checksums are not among them.
[[nodiscard]] std::vector<std::filesystem::path> level_files_of(const std::filesystem::path& chain);

}  // namespace meshbound::tools
