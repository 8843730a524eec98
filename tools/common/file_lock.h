// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <optional>

#include "mesh/descriptor.h"
#include "mesh/temporary_files.h"

namespace meshbound::tools {

/// An empty file that one process at a time holds, by flock; the destructor removes it. The lock ends with the process,
/// so that the file of a process that was killed holds up nobody. Where the file system has no locks any number of
/// processes hold it.
class FileLock {
 public:
  /// Does not wait. Throws `IoError` when the file cannot be made.
  explicit FileLock(std::filesystem::path path);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

  [[nodiscard]] bool is_held() const { return file_.is_open(); }  ///< false: by another process

 private:
  [[nodiscard]] bool is_still_there() const;

  std::filesystem::path path_;
  Descriptor file_;
  std::optional<TemporaryName> listed_;
};

}  // namespace meshbound::tools
