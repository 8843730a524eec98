// SPDX-License-Identifier: MIT
// Which attributes the formats carry.
#include <algorithm>
#include <utility>

#include "mesh/gltf_document.h"
#include "mesh/gltf_references.h"
#include "mesh/opacity.h"
#include "meshbound/error.h"
#include "meshbound/io.h"

namespace meshbound {
namespace {

struct Carried {
  bool texture_coordinates = false, normals = false, colours = false, scalars = false;
  bool opacity = true;  ///< of colours
  bool materials = false;
  bool groups = false;  ///< objects and smoothing groups, too
  bool document = false;
  TexturePrecision texture_precision = TexturePrecision::Double;
};

Carried carried_in(FileFormat format) {
  switch (format) {
    case FileFormat::Stl:
      return {};
    case FileFormat::Off:
      return {.colours = true};
    case FileFormat::Ply:
      return {.texture_coordinates = true,
              .normals = true,
              .colours = true,
              .scalars = true,
              .texture_precision = TexturePrecision::Float};
    case FileFormat::Obj:
      return {.texture_coordinates = true,
              .normals = true,
              .colours = true,
              .opacity = false,
              .materials = true,
              .groups = true};
    case FileFormat::Gltf:
    case FileFormat::Glb:
      break;
  }
  return {.texture_coordinates = true,
          .normals = true,
          .colours = true,
          .scalars = true,
          .materials = true,
          .document = true,
          .texture_precision = TexturePrecision::FloatFromTop};
}

void drop(CornerAttribute& attribute, std::size_t& lost) {
  lost += attribute.values.size();
  attribute = {};
}

void drop(TriangleLabels& labels, std::size_t& lost) {
  lost += labels.names.size();
  labels = {};
}

/// First as their own file holds them, then as the other one does: so are both compared with each other.
void round_texture_coordinates(MeshAttributes& attributes, TexturePrecision precision) {
  for (Eigen::Vector3d& value : attributes.texture_coordinates.values) {
    const Eigen::Vector2d rounded = rounded_to(precision, rounded_to(attributes.texture_precision, value.head<2>()));
    if (value.head<2>().allFinite() && !rounded.allFinite())
      throw InvalidInput("a texture coordinate is beyond the range of single precision: write OBJ, which has doubles");
    value.head<2>() = rounded;
  }
  attributes.texture_precision = precision;
}

void drop_named(const Carried& carried, MeshAttributes& attributes, DroppedAttributes& lost) {
  const auto drops = [&](const NamedAttribute& named) {
    if (attributes.document != nullptr || (named.width == 1 && carried.scalars)) return false;
    if (named.name == "COLOR_0") {
      if (!carried.colours) lost.colours += named.values.size() / named.width;
      return !carried.colours;
    }
    ++lost.other_properties;
    return true;
  };
  std::erase_if(attributes.named, drops);
}

void drop_opacity(MeshAttributes& attributes, std::size_t& lost) {
  for (NamedAttribute& named : attributes.named) {
    if (named.name != "COLOR_0") continue;
    lost += count_translucent(named);
    remove_opacity(named);
  }
}

}  // namespace

MeshAttributes carried_by(FileFormat format, MeshAttributes attributes, DroppedAttributes& lost) {
  const Carried carried = carried_in(format);
  if (attributes.document) lost.other_properties += count_lists_of_vertices(attributes.document->json);
  if (!carried.document && attributes.document) {
    lost.scene_objects += count_scene_objects(*attributes.document);
    if (carried.materials) lost.materials += count_described_materials(*attributes.document);
    lost.other_elements += attributes.document->other_elements;
    attributes.document = nullptr;
    attributes.part.clear();
  }
  if (!carried.texture_coordinates) drop(attributes.texture_coordinates, lost.texture_coordinates);
  round_texture_coordinates(attributes, carried.texture_precision);
  if (!carried.normals) drop(attributes.normals, lost.normals);
  drop_named(carried, attributes, lost);
  if (!carried.opacity) drop_opacity(attributes, lost.colours);
  // Without their library materials have names, but no looks.
  const bool loses_libraries = carried.materials || attributes.materials.empty();
  if (!carried.materials) drop(attributes.materials, lost.materials);
  if (carried.groups) return attributes;
  if (loses_libraries) lost.materials += attributes.material_libraries.size();
  attributes.material_libraries.clear();
  std::size_t known_to_document = 0;
  drop(attributes.objects, attributes.document ? known_to_document : lost.groups);
  drop(attributes.groups, lost.groups);
  drop(attributes.smoothing_groups, lost.smoothing_groups);
  return attributes;
}

bool carries_attributes(FileFormat format) {
  const Carried carried = carried_in(format);
  return carried.colours;
}

}  // namespace meshbound
