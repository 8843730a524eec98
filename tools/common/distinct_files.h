// SPDX-License-Identifier: MIT
#pragma once
#include <sys/types.h>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

namespace meshbound::tools {

/// A path on the command line, or one that a tool derives from it.
struct NamedPath {
  std::string role;  ///< the argument as the help names it: "IN", "--json"
  std::filesystem::path path;
};

/// Throws `InvalidInput`, one line, when writing an output would replace an input, a file that a glTF input is read
/// together with, or another output. Files are compared, not names: through symbolic links, as hard links of one file,
/// and where nothing is there yet by folder and name. Devices, FIFOs, "-" and "" replace nothing. To be called before
/// any work.
void require_distinct_files(const std::vector<NamedPath>& inputs, const std::vector<NamedPath>& outputs);

/// The check of `require_distinct_files` for any number of files, a file at a time: first all inputs, then all outputs.
/// Time and memory grow with the number of files.
class DistinctFiles {
 public:
  void add_input(const NamedPath& input);
  /// The files that a glTF input is read together with; reads that input.
  void add_files_beside(const NamedPath& input);
  /// Throws `InvalidInput` when writing it would replace a file that was added before.
  void add_output(const NamedPath& output);
  /// Whether writing to the path would replace a file that is there.
  [[nodiscard]] bool replaces_a_file(const std::filesystem::path& path);

 private:
  /// What identifies the file behind a path.
  struct Identity {
    dev_t device = 0;
    ino_t inode = 0;   ///< 0 where nothing is there yet
    std::string path;  ///< folder, links resolved, and name of what is not there yet

    bool operator==(const Identity&) const = default;
  };
  struct Hash {
    [[nodiscard]] std::size_t operator()(const Identity& identity) const;
  };

  void take(const NamedPath& named, const std::filesystem::path& path, const char* use);
  /// Absent for devices and other paths that writing does not replace.
  [[nodiscard]] std::optional<Identity> identity_of(const std::filesystem::path& path);
  [[nodiscard]] const std::filesystem::path& resolved(const std::filesystem::path& folder);

  std::unordered_map<Identity, std::string, Hash> uses_;  ///< "read as IN", of the first that has the file
  std::unordered_map<std::string, std::filesystem::path> resolved_;
};

}  // namespace meshbound::tools
