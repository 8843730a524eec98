// SPDX-License-Identifier: MIT
#include "common/distinct_files.h"

#include <sys/stat.h>

#include <algorithm>
#include <functional>

#include "mesh/gltf_document.h"
#include "mesh/output_target.h"
#include "meshbound/error.h"

namespace meshbound::tools {

namespace fs = std::filesystem;

std::size_t DistinctFiles::Hash::operator()(const Identity& identity) const {
  const std::size_t file = std::hash<ino_t>()(identity.inode) ^ std::hash<dev_t>()(identity.device << 1);
  return file ^ std::hash<std::string>()(identity.path);
}

/// Kept for the next file in the same folder.
const fs::path& DistinctFiles::resolved(const fs::path& folder) {
  const auto [known, is_new] = resolved_.try_emplace(folder.native());
  if (is_new) {
    std::error_code error;
    known->second = fs::weakly_canonical(fs::absolute(folder, error), error);
    if (error) known->second = folder;
  }
  return known->second;
}

std::optional<DistinctFiles::Identity> DistinctFiles::identity_of(const fs::path& path) {
  if (path.empty() || path == "-") return std::nullopt;
  const fs::path target = follow_links(path);
  struct stat status {};
  if (::stat(target.c_str(), &status) == 0) {
    if (!S_ISREG(status.st_mode)) return std::nullopt;
    return Identity{status.st_dev, status.st_ino, {}};
  }
  const fs::path folder = target.has_parent_path() ? target.parent_path() : ".";
  return Identity{0, 0, (resolved(folder) / target.filename()).native()};
}

bool DistinctFiles::replaces_a_file(const fs::path& path) {
  const std::optional<Identity> identity = identity_of(path);
  return identity && identity->inode != 0;
}

void DistinctFiles::take(const NamedPath& named, const fs::path& path, const char* use) {
  if (std::optional<Identity> identity = identity_of(path))
    uses_.try_emplace(*std::move(identity), std::string(use) + " as " + named.role);
}

void DistinctFiles::add_input(const NamedPath& input) { take(input, input.path, "read"); }

void DistinctFiles::add_files_beside(const NamedPath& input) {
  for (const fs::path& beside : files_beside(input.path)) take(input, beside, "read");
}

void DistinctFiles::add_output(const NamedPath& output) {
  std::optional<Identity> identity = identity_of(output.path);
  if (!identity) return;
  const auto [other, is_new] = uses_.try_emplace(*std::move(identity), "written as " + output.role);
  if (!is_new)
    throw InvalidInput(output.role + ": " + output.path.string() + " is the file that is " + other->second +
                       "; name another one");
}

void require_distinct_files(const std::vector<NamedPath>& inputs, const std::vector<NamedPath>& outputs) {
  DistinctFiles files;
  // Only what is there can be replaced: without such an output the inputs need not be read for the files beside them.
  const bool may_replace = std::any_of(
      outputs.begin(), outputs.end(), [&files](const NamedPath& output) { return files.replaces_a_file(output.path); });
  for (const NamedPath& input : inputs) {
    files.add_input(input);
    // An input that is not given has no path: to ask for its format throws, and the first exception of a
    // run costs 40 million instructions.
    if (may_replace && !input.path.empty()) files.add_files_beside(input);
  }
  for (const NamedPath& output : outputs) files.add_output(output);
}

}  // namespace meshbound::tools
