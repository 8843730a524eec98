// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <optional>

#include "mesh/temporary_files.h"

namespace meshbound::tools {

/// A folder for outputs. If it was made for them, it is removed again when it is still empty at the end.
class OutputFolder {
 public:
  /// Makes the folder, and those it is in, unless it is there. Throws `IoError`.
  explicit OutputFolder(std::filesystem::path path);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

 private:
  std::filesystem::path path_;
  std::optional<TemporaryName> made_;
};

}  // namespace meshbound::tools
