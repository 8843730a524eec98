// SPDX-License-Identifier: MIT
#pragma once
#include <sys/types.h>

#include <cstdint>
#include <filesystem>

#include "mesh/descriptor.h"

namespace meshbound {

/// Makes a file in `folder` that has no name there, so that no ending leaves it behind, not even a kill. Returns its
/// descriptor, for reading and writing; none where the file system knows no such files, as over a network, or where
/// `path_of_descriptor` leads nowhere.
[[nodiscard]] Descriptor open_unnamed_file(const std::filesystem::path& folder, mode_t mode);

/// A path by which this process, and others of the same user on this machine, open the file of a descriptor of
/// `process`.
[[nodiscard]] std::filesystem::path path_of_descriptor(pid_t process, int descriptor);

/// Where other processes of this user on this machine find an open file.
struct SharedFile {
  std::int64_t process = 0;
  std::int32_t descriptor = 0;          ///< in that process; -1: no file
  std::uint64_t device = 0, inode = 0;  ///< of the file, so that no other one is taken for it
};

/// For a file that this process has open; of descriptor -1 where that fails, with `errno`.
[[nodiscard]] SharedFile shared_file(int descriptor);

/// Opens the file of another process with these flags of `open`; the other process may close it meanwhile. Returns the
/// descriptor; none where `errno` says why not.
[[nodiscard]] Descriptor open_shared_file(const SharedFile& file, int flags);

/// Gives the file of `open_unnamed_file` a name, which must be free. Sets `errno` where it returns false.
[[nodiscard]] bool give_name(int descriptor, const std::filesystem::path& name);

namespace internal {
/// False in tests of file systems without such files.
extern bool has_unnamed_files;
}  // namespace internal

}  // namespace meshbound
