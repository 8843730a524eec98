// SPDX-License-Identifier: MIT
#include "mesh/file_bytes.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string>

#include "mesh/file_stop.h"
#include "meshbound/error.h"

namespace meshbound {
namespace {

constexpr std::size_t max_read = std::size_t{1} << 24;  // bytes between two looks at the token: some milliseconds

class FileDescriptor {
 public:
  explicit FileDescriptor(int fd) : fd_(fd) {}
  ~FileDescriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  FileDescriptor(const FileDescriptor&) = delete;
  FileDescriptor& operator=(const FileDescriptor&) = delete;
  [[nodiscard]] int get() const { return fd_; }

 private:
  int fd_;
};

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& reason) {
  throw IoError(path.string() + ": cannot read: " + reason);
}

}  // namespace

FileBytes::FileBytes(const std::filesystem::path& path, const StopToken& stop, std::size_t limit, std::size_t first) {
  // O_NONBLOCK: opening a fifo must not wait for somebody to write into it.
  const FileDescriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (file.get() < 0) refuse(path, std::strerror(errno));
  struct stat status {};
  if (::fstat(file.get(), &status) != 0) refuse(path, std::strerror(errno));
  if (S_ISDIR(status.st_mode)) refuse(path, "it is a folder, not a file");
  if (!S_ISREG(status.st_mode)) refuse(path, "it is not a regular file; copy the data into one first");
  const auto whole = static_cast<std::size_t>(status.st_size);
  const std::size_t size = std::min(whole - std::min(whole, first), limit);
  data_ = std::make_unique_for_overwrite<char[]>(size);
  while (size_ < size) {
    end_if_stopped(stop, path, "read");
    const ssize_t count =
        ::pread(file.get(), data_.get() + size_, std::min(size - size_, max_read), static_cast<off_t>(first + size_));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) refuse(path, std::strerror(errno));
    if (count == 0) refuse(path, "it became shorter while it was read; wait until it is complete");
    size_ += static_cast<std::size_t>(count);
  }
}

}  // namespace meshbound
