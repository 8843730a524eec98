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

/// https://github.com/KhronosGroup/glTF/tree/main/extensions/2.0/Vendor
constexpr std::array<const char*, 3> lists_of_vertices{"CESIUM_primitive_outline", "EXT_mesh_manifold",
                                                       "EXT_mesh_primitive_edge_visibility"};

std::size_t count_in(const GltfJson& object) {
  if (!object.is_object() || !object.contains("extensions") || !object["extensions"].is_object()) return 0;
  return static_cast<std::size_t>(std::count_if(lists_of_vertices.begin(), lists_of_vertices.end(),
                                                [&](const char* name) { return object["extensions"].contains(name); }));
}

void remove_from(GltfJson& object) {
  if (count_in(object) == 0) return;
  for (const char* const name : lists_of_vertices) object["extensions"].erase(name);
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
  return {found.begin(), found.end()};
}

}  // namespace meshbound
