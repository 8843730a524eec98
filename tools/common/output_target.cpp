// SPDX-License-Identifier: MIT
#include "common/output_target.h"

#include <unistd.h>

#include <system_error>

#include "meshbound/error.h"

namespace meshbound::tools {

std::filesystem::path output_target(const std::filesystem::path& path) {
  std::error_code none;
  const std::filesystem::path target =
      std::filesystem::is_symlink(path, none) ? std::filesystem::weakly_canonical(path) : path;
  if (std::filesystem::is_directory(target, none)) throw IoError(path.string() + " is a folder; name a file in it");
  const std::filesystem::path folder = target.parent_path().empty() ? "." : target.parent_path();
  if (!std::filesystem::is_directory(folder, none)) throw IoError("cannot write " + path.string() + ": no such folder");
  if (access(folder.c_str(), W_OK) != 0)
    throw IoError("cannot write " + path.string() + ": the folder is not writable");
  return target;
}

}  // namespace meshbound::tools
