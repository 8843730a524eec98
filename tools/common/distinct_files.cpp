// SPDX-License-Identifier: MIT
#include "common/distinct_files.h"

#include <sys/stat.h>

#include <algorithm>
#include <optional>

#include "mesh/gltf_document.h"
#include "mesh/output_target.h"
#include "meshbound/error.h"

namespace meshbound::tools {
namespace {

/// What identifies the file behind a path.
struct Identity {
  dev_t device = 0;
  ino_t inode = 0;             ///< 0 where nothing is there yet
  std::filesystem::path path;  ///< folder, links resolved, and name of what is not there yet

  bool operator==(const Identity&) const = default;
};

/// Absent for devices and other paths that writing does not replace.
std::optional<Identity> identity_of(const std::filesystem::path& path) {
  if (path.empty() || path == "-") return std::nullopt;
  const std::filesystem::path target = follow_links(path);
  struct stat status {};
  if (::stat(target.c_str(), &status) == 0) {
    if (!S_ISREG(status.st_mode)) return std::nullopt;
    return Identity{status.st_dev, status.st_ino, {}};
  }
  std::error_code error;
  const std::filesystem::path folder = target.has_parent_path() ? target.parent_path() : ".";
  std::filesystem::path resolved = std::filesystem::weakly_canonical(std::filesystem::absolute(folder, error), error);
  if (error) resolved = folder;
  return Identity{0, 0, resolved / target.filename()};
}

}  // namespace

void require_distinct_files(const std::vector<NamedPath>& inputs, const std::vector<NamedPath>& outputs) {
  struct Taken {
    const NamedPath* named;
    Identity identity;
    const char* use;
  };
  std::vector<Taken> taken;
  const auto take = [&](const NamedPath& input, const std::filesystem::path& path) {
    if (const std::optional<Identity> identity = identity_of(path)) taken.push_back({&input, *identity, "read"});
  };
  // Only what is there can be replaced: without such an output the inputs need not be read for the files beside them.
  const bool may_replace = std::any_of(outputs.begin(), outputs.end(), [](const NamedPath& output) {
    const std::optional<Identity> identity = identity_of(output.path);
    return identity && identity->inode != 0;
  });
  for (const NamedPath& input : inputs) {
    take(input, input.path);
    if (!may_replace) continue;
    for (const std::filesystem::path& beside : files_beside(input.path)) take(input, beside);
  }
  for (const NamedPath& output : outputs) {
    const std::optional<Identity> identity = identity_of(output.path);
    if (!identity) continue;
    for (const Taken& other : taken)
      if (other.identity == *identity)
        throw InvalidInput(output.role + ": " + output.path.string() + " is the file that is " + other.use + " as " +
                           other.named->role + "; name another one");
    taken.push_back({&output, *identity, "written"});
  }
}

}  // namespace meshbound::tools
