// SPDX-License-Identifier: MIT
// MSFT_lod: https://github.com/KhronosGroup/glTF/tree/main/extensions/2.0/Vendor/MSFT_lod
#include "mesh/gltf_levels.h"

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace meshbound {
namespace {

constexpr std::size_t alignment = 4;  // bytes: of every buffer view

class LevelMerger {
 public:
  explicit LevelMerger(const GltfContent& finest) : result_(finest) {}

  /// Copies a mesh of a level into the result and returns its number there.
  std::size_t mesh(const GltfContent& level, std::size_t number) {
    GltfJson mesh = level.json["meshes"][number];
    for (GltfJson& primitive : mesh["primitives"]) {
      if (primitive.contains("indices")) primitive["indices"] = accessor(level, primitive["indices"]);
      take_accessors(level, primitive["attributes"]);
      if (primitive.contains("targets"))
        for (GltfJson& target : primitive["targets"]) take_accessors(level, target);
    }
    result_.json["meshes"].push_back(std::move(mesh));
    return result_.json["meshes"].size() - 1;
  }

  std::size_t add_node(GltfJson node) {
    result_.json["nodes"].push_back(std::move(node));
    return result_.json["nodes"].size() - 1;
  }

  GltfJson& json() { return result_.json; }

  GltfContent finish() {
    GltfJson& used = result_.json["extensionsUsed"];
    if (std::find(used.begin(), used.end(), "MSFT_lod") == used.end()) used.push_back("MSFT_lod");
    result_.bytes.resize((result_.bytes.size() + alignment - 1) / alignment * alignment);
    result_.json["buffers"][0]["byteLength"] = result_.bytes.size();
    return std::move(result_);
  }

 private:
  void take_accessors(const GltfContent& level, GltfJson& properties) {
    for (auto& item : properties.items()) item.value() = accessor(level, item.value());
  }

  std::size_t accessor(const GltfContent& level, const GltfJson& number) {
    const auto [at, is_new] = accessors_.try_emplace({&level, number.get<std::size_t>()}, 0);
    if (!is_new) return at->second;
    GltfJson copy = level.json["accessors"][at->first.second];
    if (copy.contains("bufferView")) copy["bufferView"] = view(level, copy["bufferView"]);
    if (copy.contains("sparse"))
      for (const char* const part : {"indices", "values"})
        copy["sparse"][part]["bufferView"] = view(level, copy["sparse"][part]["bufferView"]);
    result_.json["accessors"].push_back(std::move(copy));
    return at->second = result_.json["accessors"].size() - 1;
  }

  std::size_t view(const GltfContent& level, const GltfJson& number) {
    const auto [at, is_new] = views_.try_emplace({&level, number.get<std::size_t>()}, 0);
    if (!is_new) return at->second;
    GltfJson copy = level.json["bufferViews"][at->first.second];
    result_.bytes.resize((result_.bytes.size() + alignment - 1) / alignment * alignment);
    const std::size_t offset = copy.value("byteOffset", std::size_t{0});
    copy["byteOffset"] = result_.bytes.size();
    result_.bytes += std::string_view(level.bytes).substr(offset, copy["byteLength"].get<std::size_t>());
    result_.json["bufferViews"].push_back(std::move(copy));
    return at->second = result_.json["bufferViews"].size() - 1;
  }

  using Key = std::pair<const GltfContent*, std::size_t>;
  GltfContent result_;
  std::map<Key, std::size_t> accessors_, views_;  ///< by level and number in that level: number in the result
};

/// Redirects animations of the node's morph weights to node `mesh_is_at`, if given. Returns whether the node is
/// animated.
bool retarget(GltfJson& json, std::size_t node, std::optional<std::size_t> mesh_is_at) {
  bool is_animated = false;
  if (!json.contains("animations")) return false;
  for (GltfJson& animation : json["animations"]) {
    for (GltfJson& channel : animation["channels"]) {
      GltfJson& target = channel["target"];
      if (target.value("node", node + 1) != node) continue;
      is_animated = true;
      if (mesh_is_at && target.value("path", "") == "weights") target["node"] = *mesh_is_at;
    }
  }
  return is_animated;
}

/// The node that gets the levels: the node itself or, where it has children or an animation that must apply to every
/// level, a new child that shows its mesh.
std::size_t node_of_levels(LevelMerger& merger, std::size_t node) {
  GltfJson& json = merger.json();
  if (!json["nodes"][node].contains("children") && !retarget(json, node, std::nullopt)) return node;
  GltfJson child = GltfJson::object();
  for (const char* const key : {"mesh", "skin", "weights"}) {
    if (!json["nodes"][node].contains(key)) continue;
    child[key] = json["nodes"][node][key];
    json["nodes"][node].erase(key);
  }
  const std::size_t added = merger.add_node(std::move(child));
  json["nodes"][node]["children"].push_back(added);
  retarget(json, node, added);
  return added;
}

}  // namespace

GltfContent with_levels(const std::vector<GltfContent>& levels, const std::vector<NodeCoverage>& nodes) {
  LevelMerger merger(levels.front());
  // By level and mesh of that level: mesh of the result.
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> mesh_of;
  for (const NodeCoverage& covered : nodes) {
    if (!levels.front().json["nodes"][covered.node].contains("mesh")) continue;
    const std::size_t node = node_of_levels(merger, covered.node);
    GltfJson ids = GltfJson::array();
    for (std::size_t level = 1; level < levels.size(); ++level) {
      const GltfJson& there = levels[level].json["nodes"][covered.node];
      GltfJson coarser = merger.json()["nodes"][node];
      for (const char* const key : {"mesh", "extensions", "extras", "name"}) coarser.erase(key);
      if (there.contains("mesh")) {
        const std::pair key(level, there["mesh"].get<std::size_t>());
        if (!mesh_of.contains(key)) mesh_of[key] = merger.mesh(levels[level], key.second);
        coarser["mesh"] = mesh_of[key];
      } else {
        for (const char* const key : {"skin", "weights"}) coarser.erase(key);
      }
      ids.push_back(merger.add_node(std::move(coarser)));
    }
    GltfJson& finest = merger.json()["nodes"][node];
    finest["extensions"]["MSFT_lod"] = {{"ids", std::move(ids)}};
    if (!finest.contains("extras") || finest["extras"].is_object())
      finest["extras"]["MSFT_screencoverage"] = covered.shares;
  }
  return merger.finish();
}

}  // namespace meshbound
