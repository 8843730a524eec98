// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <vector>

namespace meshbound::tools {

/// The files of an earlier run of lod_chain that `chain`, its chain.json, names and that are unchanged since: beside
/// `chain`, called lod_<number>.<format>, regular, writable, with the checksum of the document. Empty if `chain` is
/// missing or is no such document; versions that kept no checksums name no files.
[[nodiscard]] std::vector<std::filesystem::path> level_files_of(const std::filesystem::path& chain);

}  // namespace meshbound::tools
