// SPDX-License-Identifier: MIT
// https://github.com/KhronosGroup/glTF/tree/main/extensions/2.0/Khronos/KHR_texture_transform
#include "mesh/texture_transform.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "mesh/gltf_document.h"
#include "mesh/gltf_references.h"

namespace meshbound {
namespace {

/// The factor of a texture of a material; none where it has other coordinates than the first ones.
std::optional<double> scale_of(const GltfJson& texture) {
  const GltfJson::json_pointer transform("/extensions/KHR_texture_transform");
  const GltfJson& with = texture.contains(transform) ? texture[transform] : texture;
  if (number_in(with, "texCoord").value_or(number_in(texture, "texCoord").value_or(0)) != 0) return std::nullopt;
  double scale = 0;
  for (const GltfJson& factor : items_of(with, "scale"))
    if (factor.is_number()) scale = std::max(scale, std::fabs(factor.get<double>()));
  return scale > 0 ? scale : 1;
}

/// The largest factor of the textures in an object of a material, those of its extensions included; 0: there are none.
double largest_scale(const GltfJson& object) {
  double largest = 0;
  if (!object.is_object()) return largest;
  for (const auto& item : object.items()) {
    const bool is_texture = item.key().ends_with("Texture") && item.value().is_object();
    largest = std::max(largest, is_texture ? scale_of(item.value()).value_or(0) : largest_scale(item.value()));
  }
  return largest;
}

}  // namespace

double texture_scale(const MeshAttributes& attributes) {
  double largest = 0;
  if (attributes.document)
    for (const GltfJson& material : items_of(attributes.document->json, "materials"))
      largest = std::max(largest, largest_scale(material));
  return largest > 0 ? largest : 1;
}

}  // namespace meshbound
