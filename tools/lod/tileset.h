// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Geometry>
#include <string>
#include <vector>

namespace meshbound::tools {

/// A level as a tile.
struct TileLevel {
  std::string file;  ///< beside the tileset
  double error = 0;  ///< no point of level or original is further than this from the other, model units
};

/// A tileset of 3D Tiles 1.1 whose tiles are levels, the finest first here, each refined by the finer one: their
/// `geometricError` is the proven error, which must not fall from level to level. `box` holds the original and every
/// level, in the frame of the glTF files, whose y axis is the z axis of tiles.
[[nodiscard]] std::string tileset(const std::vector<TileLevel>& levels, const Eigen::AlignedBox3d& box);

}  // namespace meshbound::tools
