// SPDX-License-Identifier: MIT
#include "mesh/unnamed_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <string>

namespace meshbound {

bool internal::has_unnamed_files = true;

int open_unnamed_file(const std::filesystem::path& folder, mode_t mode) {
  if (!internal::has_unnamed_files) return -1;
  const int descriptor = ::open(folder.empty() ? "." : folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, mode);
  if (descriptor < 0 || ::access(path_of_descriptor(::getpid(), descriptor).c_str(), F_OK) == 0) return descriptor;
  ::close(descriptor);
  return -1;
}

std::filesystem::path path_of_descriptor(pid_t process, int descriptor) {
  return "/proc/" + std::to_string(process) + "/fd/" + std::to_string(descriptor);
}

SharedFile shared_file(int descriptor) {
  struct stat status {};
  if (::fstat(descriptor, &status) != 0) return {.descriptor = -1};
  return {::getpid(), descriptor, status.st_dev, status.st_ino};
}

int open_shared_file(const SharedFile& file, int flags) {
  const std::filesystem::path path = path_of_descriptor(static_cast<pid_t>(file.process), file.descriptor);
  const int descriptor = ::open(path.c_str(), flags | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) return -1;
  const SharedFile opened = shared_file(descriptor);
  if (opened.device == file.device && opened.inode == file.inode) return descriptor;
  ::close(descriptor);
  errno = ENOENT;
  return -1;
}

bool give_name(int descriptor, const std::filesystem::path& name) {
  return ::linkat(AT_FDCWD, path_of_descriptor(::getpid(), descriptor).c_str(), AT_FDCWD, name.c_str(),
                  AT_SYMLINK_FOLLOW) == 0;
}

}  // namespace meshbound
