// SPDX-License-Identifier: MIT
// Which meshes and cameras the nodes of the default scene show, and where ("glTF 2.0 Specification", 3.5).
#include <Eigen/LU>
#include <cmath>
#include <numeric>

#include "mesh/gltf_document.h"

namespace meshbound {
namespace {

Eigen::Vector3d vector_or(const GltfValue& node, const char* key, const Eigen::Vector3d& otherwise) {
  const auto found = node.find(key);
  if (!found) return otherwise;
  return {found->item(0).number(), found->item(1).number(), found->item(2).number()};
}

/// The rotation by a quaternion x, y, z, w, which is normalised first.
Eigen::Matrix3d rotation_of(const GltfValue& quaternion) {
  std::array<double, 4> q;
  for (std::size_t i = 0; i < 4; ++i) q[i] = quaternion.item(i).number();
  const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  if (!(length > 0) || !std::isfinite(length)) quaternion.fail("the quaternion has no direction");
  const double x = q[0] / length, y = q[1] / length, z = q[2] / length, w = q[3] / length;
  Eigen::Matrix3d rotation;
  rotation << 1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w),  //
      2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w),          //
      2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y);
  return rotation;
}

NodePlacement placement_of(const GltfValue& node) {
  NodePlacement placement;
  if (const auto matrix = node.find("matrix")) {
    for (std::size_t column = 0; column < 4; ++column) {
      for (std::size_t row = 0; row < 3; ++row) {
        const double number = matrix->item(4 * column + row).number();
        if (column < 3)
          placement.linear(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column)) = number;
        else
          placement.translation[static_cast<Eigen::Index>(row)] = number;
      }
      if (matrix->item(4 * column + 3).number() != (column == 3 ? 1 : 0))
        matrix->fail("the last row of the matrix is not 0 0 0 1");
    }
    return placement;
  }
  if (const auto rotation = node.find("rotation")) placement.linear = rotation_of(*rotation);
  const Eigen::Vector3d scale = vector_or(node, "scale", Eigen::Vector3d::Ones());
  for (Eigen::Index column = 0; column < 3; ++column) placement.linear.col(column) *= scale[column];
  placement.translation = vector_or(node, "translation", Eigen::Vector3d::Zero());
  return placement;
}

class SceneWalk {
 public:
  SceneWalk(const MeshSource& source, const GltfDocument& document)
      : source_(source),
        root_(source, document.json),
        nodes_(root_.count("nodes")),
        meshes_(root_.count("meshes")),
        is_visited_(nodes_, 0) {}

  PlacedObjects run() {
    const std::vector<std::size_t> roots = scene_roots();
    for (auto root = roots.rbegin(); root != roots.rend(); ++root) open_.push_back({*root, {}});
    while (!open_.empty()) {
      const Open next = open_.back();
      open_.pop_back();
      visit(next);
    }
    return std::move(placed_);
  }

 private:
  struct Open {
    std::size_t node;
    NodePlacement parent;
  };

  [[nodiscard]] GltfValue node(std::size_t i) const { return root_.at("nodes").item(i); }

  [[nodiscard]] std::vector<std::size_t> listed(const GltfValue& of, const char* key) const {
    std::vector<std::size_t> result;
    const std::size_t count = of.count(key);
    if (count == 0) return result;
    const GltfValue list = of.at(key);
    for (std::size_t i = 0; i < count; ++i) result.push_back(list.item(i).index(nodes_, "nodes"));
    return result;
  }

  [[nodiscard]] std::vector<std::size_t> scene_roots() const {
    const std::size_t scenes = root_.count("scenes");
    if (scenes > 0) {
      const auto chosen = root_.find("scene");
      return listed(root_.at("scenes").item(chosen ? chosen->index(scenes, "scenes") : 0), "nodes");
    }
    std::vector<std::uint8_t> is_child(nodes_, 0);
    for (std::size_t i = 0; i < nodes_; ++i)
      for (const std::size_t child : listed(node(i), "children")) is_child[child] = 1;
    std::vector<std::size_t> roots;
    for (std::size_t i = 0; i < nodes_; ++i)
      if (is_child[i] == 0) roots.push_back(i);
    return roots;
  }

  void visit(const Open& at) {
    source_.end_if_stopped();
    const GltfValue here = node(at.node);
    if (is_visited_[at.node] != 0) here.fail("the node has two parents, or is its own descendant");
    is_visited_[at.node] = 1;
    const NodePlacement placement = at.parent * placement_of(here);
    if (const auto extensions = here.find("extensions"); extensions && extensions->find("EXT_mesh_gpu_instancing"))
      here.fail("instances of the extension 'EXT_mesh_gpu_instancing' are not read; convert them to nodes");
    if (const auto mesh = here.find("mesh"))
      placed_.meshes.push_back({static_cast<std::uint32_t>(mesh->index(meshes_, "meshes")),
                                static_cast<std::uint32_t>(at.node), placement, here.find("skin").has_value()});
    if (here.find("camera")) placed_.cameras.push_back({static_cast<std::uint32_t>(at.node), placement});
    const std::vector<std::size_t> children = listed(here, "children");
    for (auto child = children.rbegin(); child != children.rend(); ++child) open_.push_back({*child, placement});
  }

  const MeshSource& source_;
  GltfValue root_;
  std::size_t nodes_, meshes_;
  std::vector<std::uint8_t> is_visited_;
  std::vector<Open> open_;
  PlacedObjects placed_;
};

}  // namespace

PlacedObjects placed_objects(const MeshSource& source, const GltfDocument& document) {
  return SceneWalk(source, document).run();
}

}  // namespace meshbound
