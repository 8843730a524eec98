// SPDX-License-Identifier: MIT
// 3D Tiles 1.1: https://docs.ogc.org/cs/22-025r4/22-025r4.html
#include "lod/tileset.h"

#include <nlohmann/json.hpp>

namespace meshbound::tools {

using Json = nlohmann::ordered_json;

namespace {

/// By columns, for points as viewers have turned them: (x, -z, y) for (x, y, z) of the glTF file. With z up they become
/// (x, y, z) again, with x up (y, z, x).
Json transform_of(UpAxis up) {
  if (up == UpAxis::Z) return {1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1};
  return {0, 0, 1, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 1};
}

}  // namespace

std::string tileset(const std::vector<TileLevel>& levels, const Eigen::AlignedBox3d& box, std::optional<UpAxis> up) {
  const Eigen::Vector3d middle = box.center(), half = box.sizes() / 2;
  const Json volume = {{"box", {middle.x(), -middle.z(), middle.y(), half.x(), 0, 0, 0, half.z(), 0, 0, 0, half.y()}}};
  Json tile;
  for (const TileLevel& level : levels) {
    Json coarser = {{"boundingVolume", volume},
                    {"geometricError", level.error},
                    {"refine", "REPLACE"},
                    {"content", {{"uri", level.file}}}};
    if (!tile.is_null()) coarser["children"].push_back(std::move(tile));
    tile = std::move(coarser);
  }
  if (up && up != UpAxis::Y) tile["transform"] = transform_of(*up);
  // What nobody draws is as far off as the model is large.
  const Json document = {
      {"asset", {{"version", "1.1"}}}, {"geometricError", 2 * half.norm()}, {"root", std::move(tile)}};
  return document.dump(2) + '\n';
}

}  // namespace meshbound::tools
