// SPDX-License-Identifier: MIT
#pragma once
#include <sys/types.h>

#include <filesystem>
#include <optional>

namespace meshbound {

/// Where a chain of symbolic links ends, even if nothing is there yet. O(length of the chain).
[[nodiscard]] std::filesystem::path follow_links(std::filesystem::path path);

/// The file, device or descriptor that writing to a path ends at.
struct OutputTarget {
  std::filesystem::path path;  ///< links followed
  bool is_stream = false;      ///< a device or FIFO, or a descriptor of this process: written to, never replaced
  /// The descriptor of this process that the path names (`/dev/stdout` is 1), or -1. Used as it is, so that writing
  /// continues at its position.
  int descriptor = -1;

  /// Owner and permissions of a file that is replaced, which the new file takes over.
  struct Owner {
    mode_t mode = 0;
    uid_t user = 0;
    gid_t group = 0;
  };
  std::optional<Owner> replaced;  ///< of the regular file that is there
};

/// Throws `IoError` with `path` as it was given when nothing can be written there: a folder or socket, a folder that is
/// missing or not writable, a file without write permission. The superuser may write to any file, but a file that
/// grants writing to nobody, or not to its owner where that is the superuser, is refused to the superuser as well.
[[nodiscard]] OutputTarget output_target(const std::filesystem::path& path);

}  // namespace meshbound
