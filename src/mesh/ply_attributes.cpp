// SPDX-License-Identifier: MIT
#include "mesh/ply_attributes.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace meshbound {
namespace {

constexpr std::array<std::string_view, 3> coordinate_names = {"x", "y", "z"};
constexpr std::array<std::string_view, 2> corner_names = {"vertex_indices", "vertex_index"};
constexpr std::array<std::string_view, 3> normal_names = {"nx", "ny", "nz"};
constexpr std::array<std::string_view, 8> texture_names = {"s",         "t",         "u",         "v",
                                                           "texture_s", "texture_t", "texture_u", "texture_v"};
constexpr std::array<std::string_view, 12> colour_names = {
    "red",         "green",         "blue",         "alpha",        "r", "g", "b", "a",
    "diffuse_red", "diffuse_green", "diffuse_blue", "diffuse_alpha"};

template <std::size_t N>
bool contains(const std::array<std::string_view, N>& names, const PlyProperty& property) {
  return std::find(names.begin(), names.end(), property.name) != names.end();
}

bool is_geometry(const PlyElement& element, const PlyProperty& property) {
  if (element.name == "vertex") return contains(coordinate_names, property);
  return (element.name == "face" || element.name == "tristrips") && contains(corner_names, property);
}

}  // namespace

bool lists_texture_coordinates(const PlyProperty& property) { return property.is_list && property.name == "texcoord"; }

void count_attributes(const PlyElement& element, DroppedAttributes& dropped) {
  if (element.count == 0) return;
  if (element.name == "material") {
    dropped.materials += element.count;
    return;
  }
  bool normals = false, texture = false, colours = false;
  for (const PlyProperty& property : element.properties) {
    if (is_geometry(element, property) || lists_texture_coordinates(property)) continue;
    if (contains(normal_names, property))
      normals = true;
    else if (contains(texture_names, property))
      texture = true;
    else if (contains(colour_names, property))
      colours = true;
    else
      ++dropped.other_properties;
  }
  if (normals) dropped.normals += element.count;
  if (texture) dropped.texture_coordinates += element.count;
  if (colours) dropped.colours += element.count;
}

}  // namespace meshbound
