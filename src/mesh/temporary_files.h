// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>

namespace meshbound {

struct TemporaryEntry;

/// Lists a file, or a folder, to be removed when the process ends; a folder is removed only if it is empty then. Safe
/// to use from several threads.
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

/// Removes every listed file and every listed folder that is empty. May be called by a signal handler.
void remove_temporary_files() noexcept;

}  // namespace meshbound
