// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "mesh/gltf_value.h"

namespace meshbound {

/// The value of a member that refers to an item of an array of the document, if there is one.
[[nodiscard]] std::optional<std::size_t> number_in(const GltfJson& object, const char* key);

/// The items of an array that is a member of an object; none where there is no such array.
[[nodiscard]] const GltfJson& items_of(const GltfJson& object, const char* key);

/// Calls visit(name, accessor) for each property of the vertices of a primitive, those of morph targets by
/// `target_name`. The accessor may be no number in a malformed document.
void visit_properties(const GltfJson& primitive,
                      const std::function<void(const std::string& name, const GltfJson& accessor)>& visit);

/// The number of statements in extensions of meshes and their primitives that are about vertices or triangles by their
/// numbers or order, as outlines, polygons and implicit features are: they say nothing of others.
[[nodiscard]] std::size_t count_lists_of_vertices(const GltfJson& document);

/// Removes them from a mesh and one of its primitives. A name stays in "extensionsUsed", which is no error.
void remove_lists_of_vertices(GltfJson& document, std::size_t mesh, GltfJson& primitive);

/// The accessors to which only these primitives of the document refer.
[[nodiscard]] std::vector<std::size_t> accessors_used_only_by(const std::vector<const GltfJson*>& primitives,
                                                              const GltfJson& document);

}  // namespace meshbound
