// SPDX-License-Identifier: MIT
#include "mesh/gltf_references.h"

#include <algorithm>
#include <array>
#include <set>
#include <string>

#include "mesh/gltf_attributes.h"

namespace meshbound {
namespace {

/// Calls visit(accessor) for each accessor that a primitive refers to.
template <class Visit>
void visit_accessors(const GltfJson& primitive, const Visit& visit) {
  if (const auto indices = number_in(primitive, "indices")) visit(*indices);
  visit_properties(primitive, [&](const std::string&, const GltfJson& accessor) {
    if (accessor.is_number_unsigned()) visit(accessor.get<std::size_t>());
  });
}

/// Calls visit(accessor) for each accessor of "attributes" of the node's extensions, as EXT_mesh_gpu_instancing has
/// them.
template <class Visit>
void visit_accessors_of_instances(const GltfJson& node, const Visit& visit) {
  if (!node.is_object() || !node.contains("extensions") || !node["extensions"].is_object()) return;
  for (const GltfJson& extension : node["extensions"]) {
    if (!extension.is_object() || !extension.contains("attributes") || !extension["attributes"].is_object()) continue;
    for (const auto& item : extension["attributes"].items())
      visit(number_in(extension["attributes"], item.key().c_str()));
  }
}

/// Extensions of primitives and meshes that say something of the triangles or vertices by their numbers or order:
/// https://github.com/KhronosGroup/glTF/tree/main/extensions/2.0/Vendor
constexpr std::array<const char*, 4> lists_of_vertices{"CESIUM_primitive_outline", "EXT_mesh_manifold",
                                                       "EXT_mesh_primitive_edge_visibility", "FB_ngon_encoding"};

/// Whether features are the vertices themselves, by their numbers (EXT_mesh_features).
bool is_implicit(const GltfJson& feature_ids) {
  return feature_ids.is_object() && !feature_ids.contains("attribute") && !feature_ids.contains("texture");
}

std::size_t count_in(const GltfJson& object) {
  if (!object.is_object() || !object.contains("extensions") || !object["extensions"].is_object()) return 0;
  const GltfJson& extensions = object["extensions"];
  const auto listed = std::count_if(lists_of_vertices.begin(), lists_of_vertices.end(),
                                    [&](const char* name) { return extensions.contains(name); });
  if (!extensions.contains("EXT_mesh_features")) return static_cast<std::size_t>(listed);
  const GltfJson& features = items_of(extensions["EXT_mesh_features"], "featureIds");
  return static_cast<std::size_t>(listed + std::count_if(features.begin(), features.end(), is_implicit));
}

void remove_implicit_features(GltfJson& extensions) {
  if (!extensions.contains("EXT_mesh_features")) return;
  GltfJson kept = GltfJson::array();
  for (const GltfJson& feature_ids : items_of(extensions["EXT_mesh_features"], "featureIds"))
    if (!is_implicit(feature_ids)) kept.push_back(feature_ids);
  if (kept.empty())
    extensions.erase("EXT_mesh_features");
  else
    extensions["EXT_mesh_features"]["featureIds"] = std::move(kept);
}

void remove_from(GltfJson& object) {
  if (count_in(object) == 0) return;
  for (const char* const name : lists_of_vertices) object["extensions"].erase(name);
  remove_implicit_features(object["extensions"]);
  if (object["extensions"].empty()) object.erase("extensions");
}

}  // namespace

std::size_t count_lists_of_vertices(const GltfJson& document) {
  std::size_t count = 0;
  for (const GltfJson& mesh : items_of(document, "meshes")) {
    count += count_in(mesh);
    for (const GltfJson& primitive : items_of(mesh, "primitives")) count += count_in(primitive);
  }
  return count;
}

void remove_lists_of_vertices(GltfJson& document, std::size_t mesh, GltfJson& primitive) {
  remove_from(document["meshes"][mesh]);
  remove_from(primitive);
}

std::optional<std::size_t> number_in(const GltfJson& object, const char* key) {
  const auto found = object.is_object() ? object.find(key) : object.end();
  if (!object.is_object() || found == object.end() || !found->is_number_unsigned()) return std::nullopt;
  return found->get<std::size_t>();
}

const GltfJson& items_of(const GltfJson& object, const char* key) {
  static const GltfJson nothing = GltfJson::array();
  if (!object.is_object()) return nothing;
  const auto found = object.find(key);
  return found != object.end() && found->is_array() ? *found : nothing;
}

void visit_properties(const GltfJson& primitive,
                      const std::function<void(const std::string& name, const GltfJson& accessor)>& visit) {
  const auto visit_all = [&](const GltfJson& properties, const auto& name_of) {
    if (!properties.is_object()) return;
    for (const auto& item : properties.items()) visit(name_of(item.key()), item.value());
  };
  if (primitive.contains("attributes")) visit_all(primitive["attributes"], [](const std::string& key) { return key; });
  std::size_t number = 0;
  for (const GltfJson& target : items_of(primitive, "targets")) {
    visit_all(target, [&](const std::string& key) { return target_name(number, key); });
    ++number;
  }
}

std::vector<std::size_t> accessors_used_only_by(const std::vector<const GltfJson*>& primitives,
                                                const GltfJson& document) {
  std::set<std::size_t> found;
  for (const GltfJson* primitive : primitives)
    visit_accessors(*primitive, [&](std::size_t accessor) { found.insert(accessor); });
  const auto keep = [&](std::optional<std::size_t> accessor) {
    if (accessor) found.erase(*accessor);
  };
  const std::set<const GltfJson*> given(primitives.begin(), primitives.end());
  for (const GltfJson& mesh : items_of(document, "meshes"))
    for (const GltfJson& other : items_of(mesh, "primitives"))
      if (!given.contains(&other)) visit_accessors(other, keep);
  for (const GltfJson& animation : items_of(document, "animations"))
    for (const GltfJson& sampler : items_of(animation, "samplers"))
      keep(number_in(sampler, "input")), keep(number_in(sampler, "output"));
  for (const GltfJson& skin : items_of(document, "skins")) keep(number_in(skin, "inverseBindMatrices"));
  for (const GltfJson& node : items_of(document, "nodes")) visit_accessors_of_instances(node, keep);
  return {found.begin(), found.end()};
}

}  // namespace meshbound
