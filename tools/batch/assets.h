// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace meshbound::tools {

/// A mesh file of a batch.
struct Asset {
  std::filesystem::path input;  ///< as it can be opened
  std::string name;   ///< relative to the folder, or as in the list; also the place of the result in the output folder
  std::string fault;  ///< why it cannot be read, where that is known; else empty
};

/// The mesh files below a folder, by name and without those in `output_dir`, or those that a list names, a line each,
/// relative to the working folder; empty lines and lines that begin with # are skipped. Links to folders are not
/// followed; links that lead nowhere, FIFOs and devices count as mesh files, so that they are reported, and so do
/// folders that cannot be read. A path of a list that is absolute or leads upwards keeps only its last part as its
/// name. Throws `IoError` for files that cannot be read, `InvalidInput` if there is no mesh or two would be written to
/// one place.
[[nodiscard]] std::vector<Asset> find_assets(const std::string& source, const std::filesystem::path& output_dir);

}  // namespace meshbound::tools
