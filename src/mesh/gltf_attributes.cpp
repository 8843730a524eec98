// SPDX-License-Identifier: MIT
#include "mesh/gltf_attributes.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "mesh/no_value.h"

namespace meshbound {
namespace {

/// Numbers in a colour: red, green, blue and opacity, which is 1 where the file gives none.
constexpr std::size_t colour_width = 4;

/// Replaces control characters, so that a name takes one line of a text format.
std::string one_line(std::string name) {
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c >= 0 && c < ' '; }, '_');
  return name;
}

std::string name_or(const GltfValue& object, const std::string& otherwise) {
  const auto name = object.find("name");
  return name && name->json().is_string() && !name->text().empty() ? one_line(name->text()) : otherwise;
}

bool is_colour(std::string_view semantic) { return semantic.starts_with("COLOR_"); }
bool is_direction(std::string_view semantic) { return semantic == "TANGENT" || semantic == "NORMAL"; }
bool is_skinning(std::string_view semantic) {
  return semantic.starts_with("JOINTS_") || semantic.starts_with("WEIGHTS_");
}

/// Whether the numbers have no mean: identifiers of features (EXT_mesh_features, 3D Tiles), and whole numbers of the
/// file's own.
bool is_identifier(std::string_view semantic, const GltfNumbers& numbers) {
  return semantic.starts_with("_FEATURE_ID_") || semantic == "_BATCHID" ||
         (semantic.starts_with('_') && numbers.component != GltfComponent::Float && !numbers.normalized);
}

/// The matrix that maps normals: the transposed inverse up to a positive factor, computed from cofactors, which
/// singular matrices have as well.
Eigen::Matrix3d map_of_normals(const Eigen::Matrix3d& m) {
  Eigen::Matrix3d cofactors;
  for (Eigen::Index i = 0; i < 3; ++i) cofactors.row(i) = m.row((i + 1) % 3).cross(m.row((i + 2) % 3));
  return m.determinant() < 0 ? Eigen::Matrix3d(-cofactors) : cofactors;
}

}  // namespace

const GltfAccessor& AccessorCache::at(std::size_t index) {
  const auto found = read_.find(index);
  if (found != read_.end()) return found->second;
  return read_.emplace(index, read_accessor(source_, document_, index)).first->second;
}

std::string target_name(std::size_t target, std::string_view semantic) {
  return "targets/" + std::to_string(target) + '/' + std::string(semantic);
}

GltfAttributes::GltfAttributes(AccessorCache& accessors, const GltfValue& root)
    : accessors_(accessors), accessor_count_(root.count("accessors")), material_count_(root.count("materials")) {
  for (std::size_t i = 0; i < material_count_; ++i)
    add_material(name_or(root.at("materials").item(i), "material_" + std::to_string(i)));
}

/// Materials of one name are told apart by numbers, as formats that have nothing but names would join them.
void GltfAttributes::add_material(const std::string& name) {
  std::vector<std::string>& names = all_.materials.names;
  std::string unique = name;
  for (int number = 2; !material_names_.insert(unique).second; ++number) unique = name + '_' + std::to_string(number);
  names.push_back(std::move(unique));
}

std::uint32_t GltfAttributes::add_object(const GltfValue& mesh, std::size_t number) {
  all_.objects.names.push_back(name_or(mesh, "mesh_" + std::to_string(number)));
  return static_cast<std::uint32_t>(all_.objects.names.size() - 1);
}

void GltfAttributes::begin_primitive(const GltfValue& primitive, const NodePlacement& placement, std::uint32_t part,
                                     std::uint32_t object, std::size_t vertices) {
  part_ = part;
  object_ = object;
  const auto material = primitive.find("material");
  material_ = material ? static_cast<std::uint32_t>(material->index(material_count_, "materials")) : no_value;
  texture_coordinates_ = normals_ = no_value;
  std::fill(named_.begin(), named_.end(), no_value);
  const GltfValue attributes = primitive.at("attributes");
  for (const auto& [semantic, unused] : attributes.json().items()) {
    const GltfValue accessor = attributes.at(semantic.c_str());
    if (semantic == "POSITION") continue;
    if (semantic == "NORMAL")
      use_normals(accessor, placement, vertices);
    else if (semantic == "TEXCOORD_0")
      use_texture_coordinates(accessor, vertices);
    else
      use_named(semantic, semantic, accessor, vertices);
  }
  for (std::size_t i = 0; i < primitive.count("targets"); ++i) {
    const GltfValue target = primitive.at("targets").item(i);
    if (!target.json().is_object()) target.fail("expected an object of JSON");
    for (const auto& [semantic, unused] : target.json().items())
      use_named(target_name(i, semantic), semantic, target.at(semantic.c_str()), vertices);
  }
}

const GltfAccessor& GltfAttributes::checked(const GltfValue& accessor, std::size_t vertices, std::size_t min_width) {
  const GltfAccessor& found = accessors_.at(accessor.index(accessor_count_, "accessors"));
  if (found.count < vertices)
    accessor.fail("has " + std::to_string(found.count) + " elements for " + std::to_string(vertices) + " vertices");
  if (found.numbers.width < min_width)
    accessor.fail("has elements of " + std::to_string(found.numbers.width) + " numbers, too few");
  return found;
}

void GltfAttributes::use_normals(const GltfValue& accessor, const NodePlacement& placement, std::size_t vertices) {
  const GltfAccessor& from = checked(accessor, vertices, 3);
  const Eigen::Matrix3d map = map_of_normals(placement.linear);
  normals_ = static_cast<std::uint32_t>(all_.normals.values.size());
  for (std::size_t i = 0; i < vertices; ++i) {
    const double* const n = from.values.data() + i * from.numbers.width;
    const Eigen::Vector3d mapped = map * Eigen::Vector3d(n[0], n[1], n[2]);
    all_.normals.values.push_back(mapped.allFinite() ? mapped.normalized() : Eigen::Vector3d::Zero());
  }
}

void GltfAttributes::use_texture_coordinates(const GltfValue& accessor, std::size_t vertices) {
  const GltfAccessor& from = checked(accessor, vertices, 2);
  const std::pair key("TEXCOORD_0", accessor.integer());
  const auto [at, is_new] =
      first_value_of_.try_emplace(key, static_cast<std::uint32_t>(all_.texture_coordinates.values.size()));
  texture_coordinates_ = at->second;
  for (std::size_t i = 0; is_new && i < from.count; ++i) {
    const double* const uv = from.values.data() + i * from.numbers.width;
    all_.texture_coordinates.values.emplace_back(uv[0], 1 - uv[1], 0);
  }
}

void GltfAttributes::use_named(const std::string& name, std::string_view semantic, const GltfValue& accessor,
                               std::size_t vertices) {
  const GltfAccessor& from = checked(accessor, vertices, is_colour(semantic) ? 3 : 1);
  const auto [number, is_new_name] = number_of_.try_emplace(name, all_.named.size());
  if (is_new_name) {
    NamedAttribute& made = all_.named.emplace_back();
    made.name = name;
    made.width = is_colour(semantic) ? colour_width : from.numbers.width;
    if (is_skinning(semantic) || is_identifier(semantic, from.numbers)) made.interpolation = Interpolation::Nearest;
    if (name == "TANGENT") made.interpolation = Interpolation::Direction;
    made.has_seams = !is_skinning(semantic) && !is_direction(semantic);
    made.index.assign(all_.part.size(), no_values);
    named_.push_back(no_value);
  }
  NamedAttribute& to = all_.named[number->second];
  if (!is_colour(semantic) && to.width != from.numbers.width)
    accessor.fail("has elements of " + std::to_string(from.numbers.width) +
                  " numbers, but those of another primitive " + "have " + std::to_string(to.width));
  const std::pair key(name, accessor.integer());
  const auto [at, is_new] = first_value_of_.try_emplace(key, static_cast<std::uint32_t>(to.values.size() / to.width));
  named_[number->second] = at->second;
  for (std::size_t i = 0; is_new && i < from.count; ++i) {
    const double* const numbers = from.values.data() + i * from.numbers.width;
    for (std::size_t k = 0; k < to.width; ++k) to.values.push_back(k < from.numbers.width ? numbers[k] : 1);
  }
}

void GltfAttributes::add_triangle(const Triangle& corners) {
  const auto numbers = [&](std::uint32_t first) {
    if (first == no_value) return no_values;
    return Triangle{first + corners[0], first + corners[1], first + corners[2]};
  };
  all_.texture_coordinates.index.push_back(numbers(texture_coordinates_));
  all_.normals.index.push_back(numbers(normals_));
  for (std::size_t i = 0; i < all_.named.size(); ++i) all_.named[i].index.push_back(numbers(named_[i]));
  all_.materials.index.push_back(material_);
  all_.objects.index.push_back(object_);
  all_.part.push_back(part_);
}

/// Adds a name for triangles without a material. In formats that name materials from some triangle on, such as OBJ,
/// these would otherwise count to the material before them.
void GltfAttributes::name_missing_materials() {
  if (all_.materials.names.empty()) {
    all_.materials = {};
    return;
  }
  const auto unnamed = static_cast<std::uint32_t>(all_.materials.names.size());
  if (std::find(all_.materials.index.begin(), all_.materials.index.end(), no_value) == all_.materials.index.end())
    return;
  add_material("default");
  std::replace(all_.materials.index.begin(), all_.materials.index.end(), no_value, unnamed);
}

MeshAttributes GltfAttributes::finish() {
  if (all_.texture_coordinates.values.empty()) all_.texture_coordinates = {};
  all_.texture_precision = TexturePrecision::FloatFromTop;
  if (all_.normals.values.empty()) all_.normals = {};
  name_missing_materials();
  return std::move(all_);
}

void count_attributes(const GltfValue& primitive, std::size_t vertices, DroppedAttributes& dropped) {
  for (const auto& [semantic, unused] : primitive.at("attributes").json().items()) {
    if (semantic == "NORMAL")
      dropped.normals += vertices;
    else if (semantic.starts_with("TEXCOORD_"))
      dropped.texture_coordinates += vertices;
    else if (is_colour(semantic))
      dropped.colours += vertices;
    else if (semantic != "POSITION")
      ++dropped.other_properties;
  }
  dropped.other_properties += primitive.count("targets");
}

}  // namespace meshbound
