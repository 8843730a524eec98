// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "lod/pixel_limit.h"
#include "meshbound/report.h"
#include "meshbound/stop_token.h"
#include "meshbound/triangle_mesh.h"
#include "view/scene_file.h"

namespace meshbound::tools {

/// The default scene of a glTF file for `view_levels`: its meshes are the models, the nodes that show them the
/// instances, and the nodes with perspective cameras the cameras.
struct GltfView {
  SceneFile scene;
  std::vector<TriangleMesh> meshes;  ///< by model, in its own frame
  std::vector<MeshReport> reports;   ///< by model
  // Numbers in the file, by model, instance and camera.
  std::vector<std::uint32_t> mesh_of_model, node_of_instance, node_of_camera;
  std::size_t orthographic_cameras = 0;  ///< left out, as they show all depths alike
};

[[nodiscard]] bool is_gltf(const std::string& path);  ///< by its extension

/// `limit` is what the file does not say: the error that an instance may cover. Throws as `parse_gltf_scene`, and
/// `InvalidInput` where there is no triangle or no perspective camera.
[[nodiscard]] GltfView read_gltf_view(const std::string& path, const PixelLimit& limit, const StopToken& stop);

}  // namespace meshbound::tools
