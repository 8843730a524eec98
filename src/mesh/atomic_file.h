// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <filesystem>
#include <string_view>
#include <vector>

namespace meshbound {

/// A file that appears whole or not at all: written under a temporary name in the same folder, renamed by `commit`,
/// removed by the destructor otherwise. A symbolic link is followed, so that what it points to is replaced. A device
/// (`/dev/stdout`) is written to as it is. Buffered; every member throws `IoError`, also when the disk is full.
class AtomicFile {
 public:
  explicit AtomicFile(const std::filesystem::path& path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(std::string_view bytes);

  /// At least `size` bytes (up to `largest_room`) to be filled; `use` then takes those before `end`.
  static constexpr std::size_t largest_room = 4096;
  [[nodiscard]] char* room(std::size_t size);
  void use(const char* end) { filled_ = static_cast<std::size_t>(end - buffer_.data()); }

  /// Makes the file visible under its name. Call once, last.
  void commit();

 private:
  void flush();
  void write_through(const char* from, std::size_t size);
  [[noreturn]] void fail(int error) const;

  std::filesystem::path path_;       // as the caller named it, for messages
  std::filesystem::path target_;     // links resolved
  std::filesystem::path temporary_;  // empty when writing to a device, and after the rename
  int fd_ = -1;
  std::vector<char> buffer_;
  std::size_t filled_ = 0;
};

}  // namespace meshbound
