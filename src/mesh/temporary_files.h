// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>

namespace meshbound {

struct TemporaryEntry;

/// Keeps a file, or a folder that is empty by then, in the list of what must not outlive the process. Safe to use from
/// several threads.
class TemporaryName {
 public:
  /// Throws `IoError` when `path` is longer than the system allows.
  explicit TemporaryName(const std::filesystem::path& path);
  ~TemporaryName();
  TemporaryName(const TemporaryName&) = delete;
  TemporaryName& operator=(const TemporaryName&) = delete;

 private:
  TemporaryEntry* entry_;
};

/// Removes every file and empty folder in the list, for a process that ends at once. May be called by a signal handler.
void remove_temporary_files() noexcept;

}  // namespace meshbound
