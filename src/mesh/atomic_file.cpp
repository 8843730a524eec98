// SPDX-License-Identifier: MIT
#include "mesh/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <random>
#include <string>
#include <system_error>
#include <utility>

#include "mesh/file_stop.h"
#include "meshbound/error.h"

namespace meshbound {
namespace {

constexpr std::size_t buffer_size = std::size_t{1} << 20;  // bytes: large enough that system calls cost nothing

/// A name in `folder` that no other process or thread uses, short enough for every file system. The number of the
/// process is for readers alone: processes of different containers or machines may have the same one, and a process
/// that was killed may have left files.
std::filesystem::path temporary_name(const std::filesystem::path& folder) {
  std::random_device random;
  const std::uint64_t digits = std::uint64_t{random()} << 32 | random();
  return folder / (".meshbound-" + std::to_string(::getpid()) + "-" + std::to_string(digits) + ".tmp");
}

/// Where what goes to a stream stands until it is whole.
std::filesystem::path folder_before_streams() {
  const char* const told = std::getenv("TMPDIR");
  const std::filesystem::path folder = told != nullptr && *told != 0 ? told : "/tmp";
  std::error_code error;
  if (std::filesystem::is_directory(folder, error)) return folder;
  throw IoError(folder.string() + ": not a folder for temporary files; set TMPDIR to one");
}

/// Gives the new file the owner and permissions of the replaced one. File systems without them let these calls fail,
/// which changes nothing that matters.
void hand_over(int fd, const OutputTarget::Owner& owner) {
  const bool same_owner = ::fchown(fd, owner.user, owner.group) == 0;
  // Set-user-ID and set-group-ID bits are kept only where the owner is: a file must not start to run as somebody else.
  (void)::fchmod(fd, same_owner ? owner.mode : owner.mode & 0777);
}

}  // namespace

AtomicFile::AtomicFile(std::filesystem::path path, Stream stream, const StopToken& stop)
    : path_(std::move(path)), target_(output_target(path_)), stream_(stream), stop_(stop) {}

AtomicFile::AtomicFile(std::filesystem::path path, const SharedFile& shared) : path_(std::move(path)) {
  make_buffer();
  fd_ = open_shared_file(shared, O_WRONLY).release();
  if (fd_ < 0) fail(errno);
}

AtomicFile::~AtomicFile() {
  if (fd_ >= 0) ::close(fd_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void AtomicFile::make_buffer() { buffer_ = std::make_unique_for_overwrite<char[]>(buffer_size); }

void AtomicFile::open() {
  if (fd_ >= 0) return;
  make_buffer();
  if (target_.is_stream && stream_ == Stream::Direct) return open_stream();
  open_staged(target_.is_stream ? folder_before_streams() : target_.path.parent_path());
  if (target_.replaced) hand_over(fd_, *target_.replaced);
}

void AtomicFile::open_staged(const std::filesystem::path& folder) {
  const mode_t mode = target_.is_stream ? 0600 : 0666;
  fd_ = open_unnamed_file(folder, mode).release();
  if (fd_ >= 0) {
    staged_ = path_of_descriptor(::getpid(), fd_);
    return;
  }
  std::filesystem::path name = list_temporary_name(folder);
  fd_ = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
  if (fd_ < 0) fail(errno);
  staged_ = temporary_ = std::move(name);
}

/// A free name in the folder, listed before it exists, so that no signal can come in between.
std::filesystem::path AtomicFile::list_temporary_name(const std::filesystem::path& folder) {
  std::filesystem::path name = temporary_name(folder);
  listed_.emplace(name);
  return name;
}

void AtomicFile::open_stream() {
  do {
    fd_ = target_.descriptor >= 0 ? ::fcntl(target_.descriptor, F_DUPFD_CLOEXEC, 0)
                                  : ::open(target_.path.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY);
    end_if_stopped(stop_, path_, "written");  // opening a FIFO waits for its reader, until a signal comes
  } while (fd_ < 0 && errno == EINTR);
  if (fd_ < 0) fail(errno);
}

void AtomicFile::write(std::string_view bytes) {
  open();
  if (bytes.size() > buffer_size - filled_) {
    flush();
    if (bytes.size() > buffer_size) return write_through(bytes.data(), bytes.size());
  }
  std::memcpy(buffer_.get() + filled_, bytes.data(), bytes.size());
  filled_ += bytes.size();
}

char* AtomicFile::room(std::size_t size) {
  open();
  if (size > buffer_size - filled_) flush();
  return buffer_.get() + filled_;
}

void AtomicFile::seek(std::uint64_t offset) {
  open();
  flush();
  if (::lseek(fd_, static_cast<off_t>(offset), SEEK_SET) < 0) fail(errno);
}

SharedFile AtomicFile::share() {
  open();
  const SharedFile file = shared_file(fd_);
  if (file.descriptor < 0) fail(errno);
  return file;
}

/// Network file systems report a full disk only when a descriptor is closed. That of a file without a name is all there
/// is of it, so a copy is closed.
void AtomicFile::complete() {
  open();
  flush();
  buffer_.reset();
  const bool has_no_name = !staged_.empty() && temporary_.empty();
  const int closed = has_no_name ? ::fcntl(fd_, F_DUPFD_CLOEXEC, 0) : std::exchange(fd_, -1);
  if (closed < 0 || ::close(closed) != 0) fail(errno);
}

void AtomicFile::commit() {
  if (buffer_ || staged_.empty()) complete();
  if (staged_.empty()) return;
  if (target_.is_stream) return send_staged();
  if (temporary_.empty()) name_staged();
  if (std::rename(temporary_.c_str(), target_.path.c_str()) != 0) fail(errno);
  temporary_.clear();
  listed_.reset();
}

/// A name for `rename`, which can replace a file as giving a name cannot.
void AtomicFile::name_staged() {
  std::filesystem::path name = list_temporary_name(target_.path.parent_path());
  if (!give_name(fd_, name)) fail(errno);
  temporary_ = std::move(name);
}

/// The staged file stays until the destructor removes it.
void AtomicFile::send_staged() {
  const Descriptor staged(::open(staged_.c_str(), O_RDONLY | O_CLOEXEC));
  if (!staged.is_open()) fail(errno);
  if (fd_ >= 0) ::close(std::exchange(fd_, -1));
  make_buffer();
  open_stream();
  ssize_t count = 0;
  while ((count = ::read(staged.number(), buffer_.get(), buffer_size)) != 0) {
    if (count > 0) write_through(buffer_.get(), static_cast<std::size_t>(count));
    if (count < 0 && errno != EINTR) fail(errno);
  }
  if (::close(std::exchange(fd_, -1)) != 0) fail(errno);
}

void AtomicFile::flush() { write_through(buffer_.get(), std::exchange(filled_, 0)); }

void AtomicFile::write_through(const char* from, std::size_t size) {
  while (size > 0) {
    end_if_stopped(stop_, path_, "written");
    const ssize_t written = ::write(fd_, from, std::min(size, buffer_size));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(errno);
    from += written;
    size -= static_cast<std::size_t>(written);
  }
}

void AtomicFile::fail(int error) const { throw IoError(path_.string() + ": cannot write: " + std::strerror(error)); }

}  // namespace meshbound
