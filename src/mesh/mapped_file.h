// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <filesystem>
#include <string_view>

namespace meshbound {

/// The bytes of a regular file, mapped read-only for as long as the object lives. Another process that shortens the
/// file meanwhile raises SIGBUS, as with any mapping.
class MappedFile {
 public:
  /// Throws `IoError` when `path` is missing, unreadable or anything but a regular file. Never blocks.
  explicit MappedFile(const std::filesystem::path& path);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  [[nodiscard]] std::string_view bytes() const { return {data_, size_}; }

 private:
  const char* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace meshbound
