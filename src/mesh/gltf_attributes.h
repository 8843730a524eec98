// SPDX-License-Identifier: MIT
#pragma once
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mesh/gltf_document.h"
#include "meshbound/io.h"

namespace meshbound {

/// Accessors that were read, each once: primitives often share them.
class AccessorCache {
 public:
  /// Both must outlive this.
  AccessorCache(const MeshSource& source, const GltfDocument& document) : source_(source), document_(document) {}

  /// Throws as `read_accessor`. Valid as long as this.
  [[nodiscard]] const GltfAccessor& at(std::size_t index);

 private:
  const MeshSource& source_;
  const GltfDocument& document_;
  std::map<std::size_t, GltfAccessor> read_;
};

/// The name in `MeshAttributes::named` of a property of a morph target.
[[nodiscard]] std::string target_name(std::size_t target, std::string_view semantic);

/// Collects the attributes of primitives, triangle by triangle.
class GltfAttributes {
 public:
  GltfAttributes(AccessorCache& accessors, const GltfValue& root);

  /// Starts primitive number `part` of the placed mesh: the triangles added from here on belong to it.
  void begin_primitive(const GltfValue& primitive, const NodePlacement& placement, std::uint32_t part,
                       std::uint32_t object, std::size_t vertices);
  /// Adds an object named after the mesh and returns its number.
  [[nodiscard]] std::uint32_t add_object(const GltfValue& mesh, std::size_t number);
  /// Adds a triangle of the current primitive; corners are indices of the primitive's vertices.
  void add_triangle(const Triangle& corners);

  /// Returns all attributes collected; `document` is left for the caller to set.
  [[nodiscard]] MeshAttributes finish();

 private:
  void use_normals(const GltfValue& accessor, const NodePlacement& placement, std::size_t vertices);
  void use_texture_coordinates(const GltfValue& accessor, std::size_t vertices);
  void use_named(const std::string& name, std::string_view semantic, const GltfValue& accessor, std::size_t vertices);
  void add_material(const std::string& name);
  void name_missing_materials();
  const GltfAccessor& checked(const GltfValue& accessor, std::size_t vertices, std::size_t min_width);

  AccessorCache& accessors_;
  std::size_t accessor_count_, material_count_;
  MeshAttributes all_;
  std::set<std::string> material_names_;
  std::map<std::string, std::size_t> number_of_;  // by name: index in `all_.named`
  /// By name and accessor: the number of its first value.
  std::map<std::pair<std::string, std::size_t>, std::uint32_t> first_value_of_;

  // Per attribute, the number of the value of the primitive's first vertex; `none` where the primitive lacks it.
  std::uint32_t texture_coordinates_ = CornerAttribute::none, normals_ = CornerAttribute::none;
  std::vector<std::uint32_t> named_;
  std::uint32_t material_ = CornerAttribute::none, part_ = 0, object_ = 0;
};

/// Adds what `GltfAttributes` would collect from a primitive to the counts of what is dropped.
void count_attributes(const GltfValue& primitive, std::size_t vertices, DroppedAttributes& dropped);

}  // namespace meshbound
