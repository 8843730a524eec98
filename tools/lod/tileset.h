// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "deviation/camera.h"

namespace meshbound::tools {

/// A level as a tile.
struct TileLevel {
  std::string file;  ///< beside the tileset
  double error = 0;  ///< no point of level or original is further than this from the other, model units
};

/// A tileset of 3D Tiles 1.1 whose tiles are levels, the finest first here, each refined by the finer one: their
/// `geometricError` is the proven error, which must not fall from level to level. `box` holds the original and every
/// level, in the frame of the glTF files. Viewers take its y axis as the one that points up, the z axis of tiles;
/// another `up` axis is turned there by the `transform` of the root, which only exchanges axes and so rounds nothing.
[[nodiscard]] std::string tileset(const std::vector<TileLevel>& levels, const Eigen::AlignedBox3d& box,
                                  std::optional<UpAxis> up);

}  // namespace meshbound::tools
