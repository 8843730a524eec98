// SPDX-License-Identifier: MIT
#pragma once
#include <deque>
#include <filesystem>

#include "mesh/temporary_files.h"

namespace meshbound::tools {

/// A folder for outputs. If it was made for them, it is removed again when it is still empty at the end, and so are
/// those around it that were made with it.
class OutputFolder {
 public:
  /// Makes the folder, and those it is in, unless it is there. Throws `IoError`.
  explicit OutputFolder(const std::filesystem::path& path);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

 private:
  void remove_made() const;

  std::deque<std::filesystem::path> made_;  ///< the innermost first
  std::deque<TemporaryName> listed_;        ///< the same, for signals
};

}  // namespace meshbound::tools
