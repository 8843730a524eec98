// SPDX-License-Identifier: MIT
#include "view/gltf_view.h"

#include <utility>

#include "common/mesh_input.h"
#include "common/sha256.h"
#include "mesh/file_bytes.h"
#include "mesh/file_stop.h"
#include "mesh/gltf_scene.h"
#include "meshbound/error.h"

namespace meshbound::tools {
namespace {

ViewCamera camera_of(const GltfScene::Camera& placed, const PixelLimit& limit) {
  ViewCamera camera;
  camera.position = placed.placement.translation;
  camera.direction = -placed.placement.linear.col(2);
  camera.screen = {limit.screen_height, placed.vertical_field_of_view};
  if (placed.aspect_ratio) camera.aspect_ratio = *placed.aspect_ratio;
  return camera;
}

ViewInstance instance_of(const GltfScene::Instance& placed) {
  ViewInstance instance;
  instance.model = placed.mesh;
  instance.pose.linear() = placed.placement.linear;
  instance.pose.translation() = placed.placement.translation;
  return instance;
}

}  // namespace

bool is_gltf(const std::string& path) {
  if (!has_mesh_extension(path)) return false;
  const FileFormat format = format_of(path);
  return format == FileFormat::Glb || format == FileFormat::Gltf;
}

GltfView read_gltf_view(const std::string& path, const PixelLimit& limit, const StopToken& stop) {
  const FileBytes file(path, stop);
  GltfScene read = parse_gltf_scene(path, file.bytes(), stop);
  if (read.instances.empty()) throw InvalidInput(path + ": the default scene shows no triangles");
  if (read.cameras.empty())
    throw InvalidInput(path +
                       ": the default scene has no perspective camera; say in a scene of JSON from where it is "
                       "seen (see docs/scenes.md)");
  GltfView view;
  view.scene.pixels = limit.pixels;
  view.orthographic_cameras = read.orthographic_cameras;
  const std::string checksum = sha256(file.bytes(), [&] { end_if_stopped(stop, path, "read"); });
  for (GltfScene::Mesh& mesh : read.meshes) {
    view.scene.models.push_back(path);
    view.reports.push_back(report_of(path, mesh.content, summarise(mesh.content.mesh), checksum));
    view.meshes.push_back(std::move(mesh.content.mesh));
    view.mesh_of_model.push_back(mesh.number);
  }
  for (const GltfScene::Instance& instance : read.instances) {
    view.scene.instances.push_back(instance_of(instance));
    view.node_of_instance.push_back(instance.node);
  }
  for (const GltfScene::Camera& camera : read.cameras) {
    view.scene.cameras.push_back(camera_of(camera, limit));
    view.node_of_camera.push_back(camera.node);
  }
  return view;
}

}  // namespace meshbound::tools
