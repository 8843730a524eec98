// SPDX-License-Identifier: MIT
#include "common/output_folder.h"

#include <unistd.h>

#include <system_error>

#include "meshbound/error.h"

namespace meshbound::tools {

OutputFolder::OutputFolder(const std::filesystem::path& path) {
  std::error_code error;
  if (std::filesystem::exists(path, error) && !std::filesystem::is_directory(path, error))
    throw IoError(path.string() + " is a file; name a folder");
  for (std::filesystem::path folder = path; !folder.empty() && !std::filesystem::exists(folder, error);
       folder = folder.parent_path())
    made_.push_back(folder);
  for (const std::filesystem::path& folder : made_) listed_.emplace_front(folder);
  std::filesystem::create_directories(path, error);
  if (std::filesystem::is_directory(path, error)) return;
  remove_made();
  throw IoError("cannot make the folder " + path.string() + "; name one that can be written to");
}

OutputFolder::~OutputFolder() { remove_made(); }

void OutputFolder::remove_made() const {
  for (const std::filesystem::path& folder : made_) ::rmdir(folder.c_str());  // fails when something is in it
}

}  // namespace meshbound::tools
