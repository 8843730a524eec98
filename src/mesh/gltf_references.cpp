// SPDX-License-Identifier: MIT
#include "mesh/gltf_references.h"

#include <algorithm>
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

}  // namespace

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
