// SPDX-License-Identifier: MIT
#include "mesh/unnamed_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <utility>

namespace meshbound {

bool internal::has_unnamed_files = true;

Descriptor open_unnamed_file(const std::filesystem::path& folder, mode_t mode) {
  if (!internal::has_unnamed_files) return {};
  Descriptor file(::open(folder.empty() ? "." : folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, mode));
  const bool is_found = file.is_open() && ::access(path_of_descriptor(::getpid(), file.number()).c_str(), F_OK) == 0;
  return is_found ? std::move(file) : Descriptor();
}

std::filesystem::path path_of_descriptor(pid_t process, int descriptor) {
  return "/proc/" + std::to_string(process) + "/fd/" + std::to_string(descriptor);
}

SharedFile shared_file(int descriptor) {
  struct stat status {};
  if (::fstat(descriptor, &status) != 0) return {.descriptor = -1};
  return {::getpid(), descriptor, status.st_dev, status.st_ino};
}

Descriptor open_shared_file(const SharedFile& file, int flags) {
  const std::filesystem::path path = path_of_descriptor(static_cast<pid_t>(file.process), file.descriptor);
  Descriptor descriptor(::open(path.c_str(), flags | O_CLOEXEC | O_NONBLOCK));
  if (!descriptor.is_open()) return {};
  const SharedFile opened = shared_file(descriptor.number());
  if (opened.device == file.device && opened.inode == file.inode) return descriptor;
  descriptor = {};
  errno = ENOENT;
  return {};
}

bool give_name(int descriptor, const std::filesystem::path& name) {
  return ::linkat(AT_FDCWD, path_of_descriptor(::getpid(), descriptor).c_str(), AT_FDCWD, name.c_str(),
                  AT_SYMLINK_FOLLOW) == 0;
}

}  // namespace meshbound
