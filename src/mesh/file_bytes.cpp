// SPDX-License-Identifier: MIT
#include "mesh/file_bytes.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string>
#include <utility>

#include "mesh/file_stop.h"
#include "meshbound/error.h"

namespace meshbound {
namespace {

constexpr std::size_t max_read = std::size_t{1} << 24;  // bytes between two looks at the token: some milliseconds

[[noreturn]] void refuse_to_read(const std::filesystem::path& path, const std::string& reason) {
  throw IoError(path.string() + ": cannot read: " + reason);
}

}  // namespace

RegularFile::RegularFile(std::filesystem::path path, const StopToken& stop) : path_(std::move(path)), stop_(stop) {
  // O_NONBLOCK: opening a fifo must not wait for somebody to write into it.
  descriptor_ = Descriptor(::open(path_.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  struct stat status {};
  if (!descriptor_.is_open() || ::fstat(descriptor_.number(), &status) != 0)
    refuse_to_read(path_, std::strerror(errno));
  if (S_ISDIR(status.st_mode)) refuse_to_read(path_, "it is a folder, not a file");
  if (!S_ISREG(status.st_mode)) refuse_to_read(path_, "it is not a regular file; copy the data into one first");
  size_ = static_cast<std::size_t>(status.st_size);
}

void RegularFile::read(std::size_t first, char* to, std::size_t size) const {
  for (std::size_t done = 0; done < size;) {
    end_if_stopped(stop_, path_, "read");
    const ssize_t count =
        ::pread(descriptor_.number(), to + done, std::min(size - done, max_read), static_cast<off_t>(first + done));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) refuse_to_read(path_, std::strerror(errno));
    if (count == 0) refuse_to_read(path_, "it became shorter while it was read; wait until it is complete");
    done += static_cast<std::size_t>(count);
  }
}

FileBytes::FileBytes(const std::filesystem::path& path, const StopToken& stop, std::size_t limit, std::size_t first) {
  const RegularFile file(path, stop);
  size_ = std::min(file.size() - std::min(file.size(), first), limit);
  data_ = std::make_unique_for_overwrite<char[]>(size_);
  file.read(first, data_.get(), size_);
}

FileWindow::FileWindow(const std::filesystem::path& path, const StopToken& stop, Reader reader)
    : file_(path, stop), reader_(std::move(reader)) {}

std::string_view FileWindow::at(std::size_t offset, std::size_t count) {
  constexpr std::size_t room = std::size_t{1} << 22;
  if (!reader_ && offset > first_ + bytes_.size()) {
    bytes_.clear();
    first_ = offset;
  }
  while (first_ + bytes_.size() < std::min(offset + count, size())) {
    const std::size_t end = first_ + bytes_.size();
    const std::size_t gone = std::min(offset - first_, bytes_.size());
    bytes_.erase(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(gone));
    first_ += gone;
    const std::size_t kept = bytes_.size();
    bytes_.resize(kept + std::min(std::max(room, count), size() - end));
    file_.read(end, bytes_.data() + kept, bytes_.size() - kept);
    if (reader_) reader_({bytes_.data() + kept, bytes_.size() - kept});
  }
  const std::size_t from = std::min(offset - first_, bytes_.size());
  return {bytes_.data() + from, bytes_.size() - from};
}

}  // namespace meshbound
