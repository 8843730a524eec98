// SPDX-License-Identifier: MIT
#include "mesh/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>
#include <utility>

#include "meshbound/error.h"

namespace meshbound {
namespace {

constexpr std::size_t buffer_size = std::size_t{1} << 20;  // bytes: large enough that system calls cost nothing

/// A name beside `target` that no other process or thread uses.
std::filesystem::path temporary_name(const std::filesystem::path& target) {
  static std::atomic<unsigned> counter{0};
  return target.parent_path() / (".meshbound-" + std::to_string(::getpid()) + "-" + std::to_string(counter++) + ".tmp");
}

/// Where a chain of symbolic links ends, even if nothing is there yet.
std::filesystem::path follow_links(std::filesystem::path path) {
  constexpr int longest_chain = 40;  // as the kernel's own limit
  std::error_code error;
  for (int i = 0; i < longest_chain && std::filesystem::is_symlink(path, error); ++i) {
    const std::filesystem::path next = std::filesystem::read_symlink(path, error);
    if (error) break;
    path = path.parent_path() / next;  // an absolute `next` replaces the folder
  }
  return path;
}

}  // namespace

AtomicFile::AtomicFile(const std::filesystem::path& path)
    : path_(path), target_(follow_links(path)), buffer_(buffer_size) {
  struct stat status {};
  const bool exists = ::stat(target_.c_str(), &status) == 0;
  if (exists && S_ISDIR(status.st_mode)) fail(EISDIR);
  if (exists && S_ISCHR(status.st_mode)) {
    fd_ = ::open(target_.c_str(), O_WRONLY | O_CLOEXEC);
    if (fd_ < 0) fail(errno);
    return;
  }
  if (exists && !S_ISREG(status.st_mode)) throw IoError(path_.string() + ": cannot write: not a regular file");

  std::filesystem::path name = temporary_name(target_);
  fd_ = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (fd_ < 0) fail(errno);
  temporary_ = std::move(name);
  // A file that is replaced keeps its permissions; where the file system has none this changes nothing that matters.
  if (exists) (void)::fchmod(fd_, status.st_mode & 07777);
}

AtomicFile::~AtomicFile() {
  if (fd_ >= 0) ::close(fd_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void AtomicFile::write(std::string_view bytes) {
  if (bytes.size() > buffer_.size() - filled_) {
    flush();
    if (bytes.size() > buffer_.size()) return write_through(bytes.data(), bytes.size());
  }
  std::memcpy(buffer_.data() + filled_, bytes.data(), bytes.size());
  filled_ += bytes.size();
}

char* AtomicFile::room(std::size_t size) {
  if (size > buffer_.size() - filled_) flush();
  return buffer_.data() + filled_;
}

void AtomicFile::commit() {
  flush();
  // Network file systems report a full disk only here.
  if (::close(std::exchange(fd_, -1)) != 0) fail(errno);
  if (temporary_.empty()) return;
  if (std::rename(temporary_.c_str(), target_.c_str()) != 0) fail(errno);
  temporary_.clear();
}

void AtomicFile::flush() { write_through(buffer_.data(), std::exchange(filled_, 0)); }

void AtomicFile::write_through(const char* from, std::size_t size) {
  while (size > 0) {
    const ssize_t written = ::write(fd_, from, size);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(errno);
    from += written;
    size -= static_cast<std::size_t>(written);
  }
}

void AtomicFile::fail(int error) const { throw IoError(path_.string() + ": cannot write: " + std::strerror(error)); }

}  // namespace meshbound
