// SPDX-License-Identifier: MIT
#pragma once
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <climits>
#include <filesystem>
#include <string>

namespace meshbound::testing_tools {

/// Makes folders in one another below `path` until the path of the last one, which is returned, is longer than the
/// system allows: no permission stops the superuser, but this does.
inline std::filesystem::path make_unreadable_folder(std::filesystem::path path) {
  const std::string name(NAME_MAX, 'x');
  int folder = ::open(path.c_str(), O_RDONLY | O_DIRECTORY);
  while (folder >= 0 && path.native().size() < PATH_MAX) {
    EXPECT_EQ(::mkdirat(folder, name.c_str(), 0777), 0);
    const int next = ::openat(folder, name.c_str(), O_RDONLY | O_DIRECTORY);
    ::close(folder);
    folder = next;
    path /= name;
  }
  EXPECT_GE(folder, 0);
  ::close(folder);
  return path;
}

}  // namespace meshbound::testing_tools
