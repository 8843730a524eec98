// SPDX-License-Identifier: MIT
#include "mesh/ply_attributes.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "mesh/no_value.h"

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

bool is_colour(const PlyProperty& property) { return !property.is_list && contains(colour_names, property); }

/// The component of a value that a property holds, by the position of its name in `names`, which lists `width` names
/// for each way of naming.
template <std::size_t N>
std::size_t component_of(const std::array<std::string_view, N>& names, const PlyProperty& property, std::size_t width) {
  return static_cast<std::size_t>(std::find(names.begin(), names.end(), property.name) - names.begin()) % width;
}

bool is_integer(PlyType type) { return type != PlyType::Float32 && type != PlyType::Float64; }

/// The number that stands for full intensity of a colour in a property of this type.
double full_intensity(PlyType type) {
  if (!is_integer(type)) return 1;
  return type == PlyType::UInt16 || type == PlyType::Int16 ? 65535 : 255;
}

}  // namespace

bool lists_texture_coordinates(const PlyProperty& property) { return property.is_list && property.name == "texcoord"; }

void count_attributes(const PlyElement& element, const std::vector<bool>& collected, DroppedAttributes& dropped) {
  if (element.count == 0) return;
  if (element.name == "material") {
    dropped.materials += element.count;
    return;
  }
  bool normals = false, texture = false, colours = false;
  for (std::size_t i = 0; i < element.properties.size(); ++i) {
    const PlyProperty& property = element.properties[i];
    if (is_geometry(element, property) || lists_texture_coordinates(property)) continue;
    if (!collected.empty() && collected[i]) continue;
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

PlyAttributes::Role PlyAttributes::role_of(const PlyProperty& property) const {
  if (property.is_list) return {};
  if (contains(texture_names, property)) return {Kind::Texture, component_of(texture_names, property, 2), 1};
  if (contains(normal_names, property)) return {Kind::Normal, component_of(normal_names, property, 3), 1};
  if (contains(colour_names, property))
    return {Kind::Colour, component_of(colour_names, property, 4), full_intensity(property.type)};
  const auto has_name = [&](const NamedAttribute& named) { return named.name == property.name; };
  const auto known = std::find_if(all_.named.begin(), all_.named.end(), has_name);
  return {Kind::Scalar, static_cast<std::size_t>(known - all_.named.begin()), 1};
}

PlyAttributes::Role PlyAttributes::new_role_of(const PlyProperty& property, const std::vector<Role>& given) const {
  const Role role = role_of(property);
  const auto is_given = [&](const Role& other) { return other.kind == role.kind && other.component == role.component; };
  return std::any_of(given.begin(), given.end(), is_given) ? Role{} : role;
}

void PlyAttributes::begin_vertices(const PlyElement& element) {
  for (const PlyProperty& property : element.properties) {
    const Role role = is_geometry(element, property) ? Role{} : new_role_of(property, vertex_roles_);
    if (role.kind == Kind::Texture) note_texture(property.type);
    has_texture_ = has_texture_ || role.kind == Kind::Texture;
    has_normals_ = has_normals_ || role.kind == Kind::Normal;
    has_vertex_colours_ = has_vertex_colours_ || role.kind == Kind::Colour;
    if (role.kind == Kind::Colour && role.component == 3) colour_width_ = 4;
    if (role.kind == Kind::Scalar) {
      scalars_.push_back(0);
      all_.named.push_back(
          {.name = property.name,
           .interpolation = is_integer(property.type) ? Interpolation::Nearest : Interpolation::Linear});
    }
    vertex_roles_.push_back(role);
  }
}

void PlyAttributes::note_texture(PlyType type) {
  if (type == PlyType::Float32) all_.texture_precision = TexturePrecision::Float;
}

void PlyAttributes::begin_faces(const PlyElement& element) {
  face_roles_.clear();
  has_face_colours_ = false;
  colour_ = {0, 0, 0, 1};
  const bool can_widen = colours_.values.empty();  // earlier faces may have colours of three numbers
  for (const PlyProperty& property : element.properties) {
    if (lists_texture_coordinates(property) && wants_texture_lists()) note_texture(property.type);
    Role role = is_colour(property) && !has_vertex_colours_ ? new_role_of(property, face_roles_) : Role{};
    if (role.component == 3 && can_widen) colour_width_ = 4;
    if (role.component == colour_width_) role = {};
    has_face_colours_ = has_face_colours_ || role.kind == Kind::Colour;
    face_roles_.push_back(role);
  }
}

std::vector<bool> PlyAttributes::collected(const PlyElement& element) const {
  std::vector<bool> result;
  if (element.name != "vertex" && element.name != "face") return result;
  for (const Role& role : element.name == "vertex" ? vertex_roles_ : face_roles_)
    result.push_back(role.kind != Kind::Nothing);
  return result;
}

void PlyAttributes::take(const Role& role, double value) {
  switch (role.kind) {
    case Kind::Texture:
      texture_[role.component] = value;
      return;
    case Kind::Normal:
      normal_[role.component] = value;
      return;
    case Kind::Colour:
      colour_[role.component] = value / role.unit;
      return;
    case Kind::Scalar:
      scalars_[role.component] = value;
      return;
    case Kind::Nothing:
      return;
  }
}

void PlyAttributes::add_colour() {
  const auto width = static_cast<std::ptrdiff_t>(colour_width_);
  colours_.values.insert(colours_.values.end(), colour_.begin(), colour_.begin() + width);
}

void PlyAttributes::end_vertex() {
  if (has_texture_) all_.texture_coordinates.values.emplace_back(texture_[0], texture_[1], 0);
  if (has_normals_) all_.normals.values.emplace_back(normal_[0], normal_[1], normal_[2]);
  if (has_vertex_colours_) add_colour();
  for (std::size_t i = 0; i < scalars_.size(); ++i) all_.named[i].values.push_back(scalars_[i]);
}

void PlyAttributes::end_face(std::size_t triangle, std::size_t corners,
                             const std::vector<double>& texture_coordinates) {
  if (corners < 3) return;
  if (has_face_colours_) {
    const auto colour = static_cast<std::uint32_t>(colours_.values.size() / colour_width_);
    add_colour();
    colours_.index.resize(triangle, no_values);
    colours_.index.insert(colours_.index.end(), corners - 2, {colour, colour, colour});
  }
  if (!wants_texture_lists()) return;
  corner_texture_.resize(triangle, no_values);
  std::vector<Eigen::Vector3d>& values = all_.texture_coordinates.values;
  const auto first = static_cast<std::uint32_t>(values.size());
  const bool has_coordinates = texture_coordinates.size() == 2 * corners;
  for (std::size_t i = 0; has_coordinates && i < corners; ++i)
    values.emplace_back(texture_coordinates[2 * i], texture_coordinates[2 * i + 1], 0);
  for (std::uint32_t i = 2; i < corners; ++i)
    corner_texture_.push_back(has_coordinates ? Triangle{first, first + i - 1, first + i} : no_values);
}

MeshAttributes PlyAttributes::finish(const std::vector<Triangle>& triangles) {
  if (has_texture_) all_.texture_coordinates.index = triangles;
  if (has_normals_) all_.normals.index = triangles;
  for (NamedAttribute& named : all_.named) named.index = triangles;
  if (!has_texture_ && !all_.texture_coordinates.values.empty()) {
    all_.texture_coordinates.index = std::move(corner_texture_);
    all_.texture_coordinates.index.resize(triangles.size(), no_values);
  }
  if (has_vertex_colours_ || !colours_.values.empty()) {
    colours_.name = "COLOR_0";
    colours_.width = colour_width_;
    if (has_vertex_colours_) colours_.index = triangles;
    colours_.index.resize(triangles.size(), no_values);
    all_.named.push_back(std::move(colours_));
  }
  return std::move(all_);
}

}  // namespace meshbound
