// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <filesystem>
#include <limits>
#include <memory>
#include <string_view>

#include "meshbound/stop_token.h"

namespace meshbound {

/// The bytes of a regular file, copied into memory: a mapping would be as fast, but the process dies of SIGBUS when
/// somebody shortens the file while it is parsed, and no message can be given.
class FileBytes {
 public:
  /// Throws `IoError` when `path` is missing, unreadable, anything but a regular file, or shortened meanwhile;
  /// `Interrupted` or `Stopped` as `stop` says. Never blocks. Reads at most `limit` bytes, those from `first` on.
  explicit FileBytes(const std::filesystem::path& path, const StopToken& stop = {},
                     std::size_t limit = std::numeric_limits<std::size_t>::max(), std::size_t first = 0);

  [[nodiscard]] std::string_view bytes() const { return {data_.get(), size_}; }

 private:
  std::unique_ptr<char[]> data_;
  std::size_t size_ = 0;
};

}  // namespace meshbound
