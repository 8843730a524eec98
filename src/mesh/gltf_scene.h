// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "mesh/mesh_source.h"
#include "mesh/scene_layout.h"
#include "meshbound/io.h"

namespace meshbound {

/// The default scene of a glTF file, not joined to one mesh.
struct GltfScene {
  /// A mesh in its own frame, which the placements of nodes take to the scene.
  struct Mesh {
    std::uint32_t number = 0;  ///< in the file
    MeshFile content;
  };
  struct Instance {
    std::size_t mesh = 0;  ///< of `meshes`
    std::uint32_t node = 0;
    NodePlacement placement;
  };
  /// A perspective camera, which looks along -z of its node.
  struct Camera {
    std::uint32_t node = 0;
    NodePlacement placement;
    double vertical_field_of_view = 0;   ///< radians, between 0 and pi
    std::optional<double> aspect_ratio;  ///< width by height, positive; absent: that of the screen
  };

  std::vector<Mesh> meshes;         ///< that nodes show and that have triangles, in the order of these nodes
  std::vector<Instance> instances;  ///< in the order of the nodes
  std::vector<Camera> cameras;      ///< in the order of the nodes
  std::size_t orthographic_cameras = 0;
};

/// Reads the default scene as `parse_mesh` does, but each mesh once. Throws as it, save that a scene may have no
/// triangles.
[[nodiscard]] GltfScene parse_gltf_scene(const std::filesystem::path& path, std::string_view bytes,
                                         const StopToken& stop = {});
[[nodiscard]] GltfScene read_gltf_scene(const MeshSource& source);

}  // namespace meshbound
