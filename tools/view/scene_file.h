// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <vector>

#include "lod/pixel_limit.h"
#include "meshbound/view_levels.h"

namespace meshbound::tools {

/// What a scene file says (tools/schema/scene-1.schema.json).
struct SceneFile {
  std::vector<std::string> models;  ///< paths, taken from the folder of the file
  std::vector<ViewInstance> instances;
  std::vector<std::string> groups;  ///< names, by the group numbers of the instances
  std::vector<ViewCamera> cameras;
  double pixels = PixelLimit().pixels;
};

/// Reads and checks a scene. Throws `IoError` when it cannot be read, and `InvalidInput` with the place in it, such as
/// "scene.json: instances[3].pose", for what is missing, unknown or of the wrong kind.
[[nodiscard]] SceneFile read_scene(const std::string& path);

}  // namespace meshbound::tools
