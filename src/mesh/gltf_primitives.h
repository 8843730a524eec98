// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "mesh/gltf_buffer.h"
#include "mesh/gltf_document.h"

namespace meshbound {

/// How the numbers of each property of a primitive are stored, by the names of `MeshAttributes::named`.
using GltfLayout = std::map<std::string, GltfNumbers>;

/// Makes the accessors of some triangles of a mesh and puts them into a primitive: "indices", all "attributes" and
/// "targets" of the layout that the triangles have values of, triangles as the mode. "POSITION" are floats in the frame
/// of `placement`, which must be invertible.
void write_primitive(GltfBuffer& buffer, GltfJson& primitive, const TriangleMesh& mesh,
                     const MeshAttributes& attributes, const std::vector<std::uint32_t>& triangles,
                     const NodePlacement& placement, const GltfLayout& layout);

/// The position that is written for a vertex: the floats in the frame of the node.
[[nodiscard]] Eigen::Vector3d written_position(const NodePlacement& placement, const Eigen::Vector3d& p);

/// The morph target and its property that a name of `MeshAttributes::named` stands for; target -1 for any other name.
struct TargetProperty {
  std::ptrdiff_t target = -1;
  std::string semantic;
};
[[nodiscard]] TargetProperty target_property(const std::string& name);

}  // namespace meshbound
