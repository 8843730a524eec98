// SPDX-License-Identifier: MIT
#include "batch/assets.h"

#include <algorithm>
#include <fstream>

#include "common/folder_files.h"
#include "common/mesh_input.h"
#include "meshbound/error.h"

namespace meshbound::tools {
namespace {

namespace fs = std::filesystem;

std::vector<Asset> below_folder(const std::string& folder, const fs::path& output_dir) {
  const auto name_of = [&folder](const fs::path& path) { return path.lexically_relative(folder).string(); };
  const FolderFiles found = files_below(folder, output_dir);
  std::vector<Asset> assets;
  for (const fs::path& path : found.files)
    if (has_mesh_extension(path)) assets.push_back({path, name_of(path), ""});
  for (const UnreadableFolder& unreadable : found.unreadable)
    assets.push_back({unreadable.path, name_of(unreadable.path), unreadable.reason});
  return assets;
}

std::string name_in_list(const fs::path& path) {
  const fs::path normal = path.lexically_normal();
  const bool leads_out = normal.is_absolute() || normal.begin()->string() == "..";
  return leads_out ? normal.filename().string() : normal.string();
}

std::vector<Asset> of_list(const std::string& path) {
  std::ifstream list(path);
  if (!list) throw IoError("--batch: cannot read " + path);
  const std::string takes = "--batch takes a folder or a list of files; ";
  if (has_mesh_extension(path)) throw InvalidInput(takes + path + " is a mesh: give it as IN");
  std::vector<Asset> assets;
  for (std::string line; std::getline(list, line);) {
    if (line.find('\0') != std::string::npos) throw InvalidInput(takes + path + " is not text: it has bytes of 0");
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (!line.empty() && line.front() != '#') assets.push_back({line, name_in_list(line), ""});
  }
  return assets;
}

}  // namespace

std::vector<Asset> find_assets(const std::string& source, const fs::path& output_dir) {
  std::error_code error;
  std::vector<Asset> assets = fs::is_directory(source, error) ? below_folder(source, output_dir) : of_list(source);
  if (assets.empty()) throw InvalidInput("--batch: there is no mesh file in " + source);
  std::sort(assets.begin(), assets.end(), [](const Asset& a, const Asset& b) { return a.name < b.name; });
  const auto twin =
      std::adjacent_find(assets.begin(), assets.end(), [](const Asset& a, const Asset& b) { return a.name == b.name; });
  if (twin != assets.end())
    throw InvalidInput("--batch: " + twin->input.string() + " and " + (twin + 1)->input.string() +
                       " would both be written to " + (output_dir / twin->name).string());
  return assets;
}

}  // namespace meshbound::tools
