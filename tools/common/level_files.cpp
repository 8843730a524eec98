// SPDX-License-Identifier: MIT
#include "common/level_files.h"

#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>

#include "common/sha256.h"
#include "common/signals.h"
#include "mesh/file_bytes.h"
#include "meshbound/error.h"

namespace meshbound::tools {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

std::string word(const Json& object, const char* key) {
  const auto found = object.is_object() ? object.find(key) : object.end();
  return found != object.end() && found->is_string() ? found->get<std::string>() : "";
}

bool is_as_written(const fs::path& path, const std::string& checksum) {
  std::error_code error;
  const fs::file_status status = fs::symlink_status(path, error);
  constexpr fs::perms writers = fs::perms::owner_write | fs::perms::group_write | fs::perms::others_write;
  if (error || !fs::is_regular_file(status) || (status.permissions() & writers) == fs::perms::none) return false;
  try {
    return sha256(FileBytes(path, stop_at_signal()).bytes()) == checksum;
  } catch (const IoError&) {
    return false;
  }
}

}  // namespace

std::vector<fs::path> level_files_of(const fs::path& chain) {
  std::error_code error;
  if (!fs::is_regular_file(chain, error)) return {};
  std::ifstream in(chain, std::ios::binary);
  const Json document = Json::parse(in, nullptr, false);
  if (word(document, "schema") != "meshbound/lod/1" || !document.contains("levels")) return {};
  static const std::regex level_name("lod_[0-9]+[.](ply|obj|off|stl|glb|gltf)");
  std::vector<fs::path> files;
  for (const Json& level : document["levels"]) {
    const std::string name = word(level, "file"), checksum = word(level, "sha256");
    const fs::path path = chain.parent_path() / name;
    if (std::regex_match(name, level_name) && is_as_written(path, checksum)) files.push_back(path);
  }
  return files;
}

}  // namespace meshbound::tools
