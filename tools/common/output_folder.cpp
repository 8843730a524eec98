// SPDX-License-Identifier: MIT
#include "common/output_folder.h"

#include <unistd.h>

#include <system_error>
#include <utility>

#include "meshbound/error.h"

namespace meshbound::tools {

OutputFolder::OutputFolder(std::filesystem::path path) : path_(std::move(path)) {
  std::error_code error;
  if (std::filesystem::exists(path_, error) && !std::filesystem::is_directory(path_, error))
    throw IoError(path_.string() + " is a file; name a folder");
  if (!std::filesystem::exists(path_, error)) made_.emplace(path_);
  std::filesystem::create_directories(path_, error);
  if (!std::filesystem::is_directory(path_, error))
    throw IoError("cannot make the folder " + path_.string() + "; name one that can be written to");
}

OutputFolder::~OutputFolder() {
  if (made_) ::rmdir(path_.c_str());  // fails when something is in it
}

}  // namespace meshbound::tools
