// SPDX-License-Identifier: MIT
#include "decimation/dropped_attributes.h"

namespace meshbound::tools {
namespace {

void append(std::string& list, std::size_t count, const char* one, const char* several) {
  if (count == 0) return;
  if (!list.empty()) list += ", ";
  list += std::to_string(count) + " " + (count == 1 ? one : several);
}

}  // namespace

std::string listed(const DroppedAttributes& dropped) {
  std::string list;
  append(list, dropped.texture_coordinates, "texture coordinate", "texture coordinates");
  append(list, dropped.normals, "normal", "normals");
  append(list, dropped.colours, "colour", "colours");
  append(list, dropped.materials, "material", "materials");
  append(list, dropped.groups, "group", "groups");
  append(list, dropped.smoothing_groups, "smoothing group", "smoothing groups");
  append(list, dropped.facet_attributes, "facet attribute", "facet attributes");
  append(list, dropped.other_properties, "other property", "other properties");
  append(list, dropped.scene_objects, "texture, camera, light, animation or skin",
         "textures, cameras, lights, animations and skins");
  append(list, dropped.other_elements, "line, point or empty face", "lines, points or empty faces");
  return list;
}

}  // namespace meshbound::tools
