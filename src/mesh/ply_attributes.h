// SPDX-License-Identifier: MIT
#pragma once
#include "mesh/ply_header.h"
#include "meshbound/io.h"

namespace meshbound {

/// Whether a property is the list of texture coordinates of a face's corners, two numbers each, which MeshLab writes.
[[nodiscard]] bool lists_texture_coordinates(const PlyProperty& property);

/// Adds what an element has beyond positions and corners: texture coordinates, normals and colours by the usual names
/// of their properties, every other property as such. What the lists of `lists_texture_coordinates` hold is not known
/// from the header and left out.
void count_attributes(const PlyElement& element, DroppedAttributes& dropped);

}  // namespace meshbound
