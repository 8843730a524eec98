// SPDX-License-Identifier: MIT
#include "mesh/unnamed_file.h"

#include <fcntl.h>
#include <unistd.h>

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

bool give_name(int descriptor, const std::filesystem::path& name) {
  return ::linkat(AT_FDCWD, path_of_descriptor(::getpid(), descriptor).c_str(), AT_FDCWD, name.c_str(),
                  AT_SYMLINK_FOLLOW) == 0;
}

}  // namespace meshbound
