// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace meshbound::tools {

/// A folder that cannot be read, for instance as it belongs to somebody else.
struct UnreadableFolder {
  std::filesystem::path path;
  std::string reason;  ///< a sentence that begins with the path
};

struct FolderFiles {
  std::vector<std::filesystem::path> files;  ///< whatever is no folder, nor a link to one; in no order
  std::vector<UnreadableFolder> unreadable;  ///< what is in these is missing
};

/// Everything below `folder` but not below `left_out`, which need not be there. Links to folders are not followed.
/// Throws `IoError` if `folder` itself cannot be read. O(files).
[[nodiscard]] FolderFiles files_below(const std::filesystem::path& folder, const std::filesystem::path& left_out = {});

}  // namespace meshbound::tools
