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
  file_ = open_unnamed_file(space_.folder, 0600);
  if (file_.is_open()) return;
  std::string name = space_.folder / ".meshbound-XXXXXX";
  file_ = Descriptor(::mkostemp(name.data(), O_CLOEXEC));
  if (!file_.is_open()) fail("make", errno);
  ::unlink(name.c_str());
}

ByteStore::ByteStore(const StoreSpace& space, const SharedBytes& shared) : space_(space), written_(shared.size) {
  file_ = open_shared_file(shared.file, O_RDWR);
  if (!file_.is_open()) fail("open", errno);
}

SharedBytes ByteStore::share() {
  write_chunk();
  const SharedFile file = shared_file(file_.number());
  if (file.descriptor < 0) fail("find", errno);
  return {file, written_};
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
  if (!file_.is_open()) {
    chunks_.push_back(std::move(last_));
  } else {
    for (std::size_t done = 0; done < filled_;) {
      const ssize_t count =
          ::pwrite(file_.number(), last_.get() + done, filled_ - done, static_cast<off_t>(written_ + done));
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
    if (!file_.is_open()) {
      const auto from = static_cast<std::size_t>(first % chunk_size);
      count = std::min(size, chunk_size - from);
      std::memcpy(to, chunks_[static_cast<std::size_t>(first / chunk_size)].get() + from, count);
    } else {
      const ssize_t read = ::pread(file_.number(), to, size, static_cast<off_t>(first));
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
