// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <string_view>
#include <vector>

#include "mesh/descriptor.h"
#include "meshbound/stop_token.h"

namespace meshbound {

/// A regular file that is open for reading. Any number of threads may read.
class RegularFile {
 public:
  /// Throws `IoError` when `path` is missing, unreadable or anything but a regular file. Never blocks.
  RegularFile(std::filesystem::path path, const StopToken& stop);

  [[nodiscard]] std::size_t size() const { return size_; }
  /// Throws `IoError` where this fails or the file is shorter by now; `Interrupted` or `Stopped` as `stop` says.
  void read(std::size_t first, char* to, std::size_t size) const;

 private:
  std::filesystem::path path_;
  StopToken stop_;
  Descriptor descriptor_;
  std::size_t size_ = 0;
};

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

/// The bytes of a regular file from its start to its end, some megabytes of it in memory at a time. Without a reader,
/// bytes that are stepped over are not read.
class FileWindow {
 public:
  /// Gets all bytes up to those that `at` has been asked for, in order, each once.
  using Reader = std::function<void(std::string_view)>;

  /// Throws as `FileBytes`, as does `at`.
  FileWindow(const std::filesystem::path& path, const StopToken& stop, Reader reader = {});

  [[nodiscard]] std::size_t size() const { return file_.size(); }
  /// The bytes from `offset` on, at least `count` of them or all that are left. `offset` must not be before that of an
  /// earlier call. Holds until the next call.
  [[nodiscard]] std::string_view at(std::size_t offset, std::size_t count);

 private:
  RegularFile file_;
  Reader reader_;
  std::vector<char> bytes_;
  std::size_t first_ = 0;  ///< offset of these in the file
};

}  // namespace meshbound
