// SPDX-License-Identifier: MIT
#include "mesh/byte_store.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>
#include <utility>

#include "meshbound/error.h"

namespace meshbound {
namespace {

constexpr std::size_t chunk_size = std::size_t{1} << 18;  // bytes: large enough that system calls cost nothing

}  // namespace

ByteStore::ByteStore(const StoreSpace& space) : space_(space) {
  if (space_.folder.empty()) return;
  fd_ = open_unnamed_file(space_.folder, 0600);
  if (fd_ >= 0) return;
  std::string name = space_.folder / ".meshbound-XXXXXX";
  fd_ = ::mkostemp(name.data(), O_CLOEXEC);
  if (fd_ < 0) fail("make", errno);
  ::unlink(name.c_str());
}

ByteStore::ByteStore(const StoreSpace& space, const SharedBytes& shared) : space_(space), written_(shared.size) {
  fd_ = open_shared_file(shared.file, O_RDWR);
  if (fd_ < 0) fail("open", errno);
}

SharedBytes ByteStore::share() {
  write_chunk();
  const SharedFile file = shared_file(fd_);
  if (file.descriptor < 0) fail("find", errno);
  return {file, written_};
}

ByteStore::~ByteStore() {
  if (fd_ >= 0) ::close(fd_);
}

ByteStore::ByteStore(ByteStore&& other) noexcept
    : space_(std::move(other.space_)),
      fd_(std::exchange(other.fd_, -1)),
      chunks_(std::move(other.chunks_)),
      last_(std::move(other.last_)),
      filled_(std::exchange(other.filled_, 0)),
      written_(std::exchange(other.written_, 0)) {}

ByteStore& ByteStore::operator=(ByteStore&& other) noexcept {
  std::swap(space_, other.space_);
  std::swap(fd_, other.fd_);
  std::swap(chunks_, other.chunks_);
  std::swap(last_, other.last_);
  std::swap(filled_, other.filled_);
  std::swap(written_, other.written_);
  return *this;
}

void ByteStore::fail(const char* action, int error) const {
  throw IoError(space_.folder.string() + ": cannot " + action + " a temporary file: " + std::strerror(error) +
                "; choose another folder for temporary files");
}

void ByteStore::append(const void* bytes, std::size_t size) {
  const char* from = static_cast<const char*>(bytes);
  while (size > 0) {
    if (!last_) last_ = std::make_unique_for_overwrite<char[]>(chunk_size);
    const std::size_t count = std::min(size, chunk_size - filled_);
    std::memcpy(last_.get() + filled_, from, count);
    filled_ += count;
    from += count;
    size -= count;
    if (filled_ == chunk_size) write_chunk();
  }
}

void ByteStore::write_chunk() {
  if (fd_ < 0) {
    chunks_.push_back(std::move(last_));
  } else {
    for (std::size_t done = 0; done < filled_;) {
      const ssize_t count = ::pwrite(fd_, last_.get() + done, filled_ - done, static_cast<off_t>(written_ + done));
      if (count < 0 && errno == EINTR) continue;
      if (count < 0) fail("write", errno);
      done += static_cast<std::size_t>(count);
    }
  }
  written_ += filled_;
  filled_ = 0;
}

void ByteStore::read(std::uint64_t first, void* to, std::size_t size) const {
  char* into = static_cast<char*>(to);
  if (first < written_) {
    const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(size, written_ - first));
    read_written(first, into, count);
    first += count;
    into += count;
    size -= count;
  }
  if (size > 0) std::memcpy(into, last_.get() + (first - written_), size);
}

void ByteStore::read_written(std::uint64_t first, char* to, std::size_t size) const {
  while (size > 0) {
    std::size_t count = 0;
    if (fd_ < 0) {
      const auto from = static_cast<std::size_t>(first % chunk_size);
      count = std::min(size, chunk_size - from);
      std::memcpy(to, chunks_[static_cast<std::size_t>(first / chunk_size)].get() + from, count);
    } else {
      const ssize_t read = ::pread(fd_, to, size, static_cast<off_t>(first));
      if (read < 0 && errno == EINTR) continue;
      if (read <= 0) fail("read", read < 0 ? errno : EIO);
      count = static_cast<std::size_t>(read);
    }
    first += count;
    to += count;
    size -= count;
  }
}

}  // namespace meshbound
