// SPDX-License-Identifier: MIT
#include "common/file_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "meshbound/error.h"

namespace meshbound::tools {

FileLock::FileLock(std::filesystem::path path) : path_(std::move(path)) {
  do {
    file_ = Descriptor(::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666));
    if (!file_.is_open()) throw IoError("cannot write to " + path_.string() + ": " + std::strerror(errno));
    if (::flock(file_.number(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
      file_ = Descriptor();
      return;
    }
  } while (!is_still_there());  // else its holder removed it after it was opened here
  listed_.emplace(path_);
}

bool FileLock::is_still_there() const {
  struct stat opened {};
  struct stat named {};
  return ::fstat(file_.number(), &opened) == 0 && ::stat(path_.c_str(), &named) == 0 && opened.st_dev == named.st_dev &&
         opened.st_ino == named.st_ino;
}

FileLock::~FileLock() {
  if (!is_held()) return;
  ::unlink(path_.c_str());  // before it is unlocked: nobody else has it yet
}

}  // namespace meshbound::tools
