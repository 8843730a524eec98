// SPDX-License-Identifier: MIT
#include "common/folder_files.h"

#include <system_error>
#include <utility>

#include "meshbound/error.h"

namespace meshbound::tools {

namespace fs = std::filesystem;

FolderFiles files_below(const fs::path& folder, const fs::path& left_out) {
  FolderFiles found;
  std::vector<fs::path> open{folder};
  while (!open.empty()) {
    const fs::path path = std::move(open.back());
    open.pop_back();
    std::error_code error;
    const fs::directory_iterator end;
    for (fs::directory_iterator it(path, error); !error && it != end; it.increment(error)) {
      std::error_code none;
      if (!it->is_directory(none))
        found.files.push_back(it->path());
      else if (!it->is_symlink(none) && !fs::equivalent(it->path(), left_out, none))
        open.push_back(it->path());
    }
    if (error) found.unreadable.push_back({path, path.string() + ": cannot read the folder: " + error.message()});
    if (error && path == folder) throw IoError(found.unreadable.back().reason);
  }
  return found;
}

}  // namespace meshbound::tools
