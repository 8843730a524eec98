// SPDX-License-Identifier: MIT
#pragma once
#include <string>

#include "mesh/gltf_value.h"
#include "meshbound/attributes.h"
#include "meshbound/error.h"

namespace meshbound {

/// What is written to a glTF file: its JSON and the bytes of its single buffer, empty where it has none.
struct GltfContent {
  GltfJson json;
  std::string bytes;
};

/// The document that the mesh was read from with its triangles replaced by those of `mesh`; a new document for a mesh
/// of another format. Throws `InvalidInput` where the document is malformed in a part that reading triangles does not
/// touch.
[[nodiscard]] GltfContent gltf_content(const TriangleMesh& mesh, const MeshAttributes& attributes);

/// What to throw where JSON of a file, read before, is malformed in a part that reading triangles does not touch.
[[nodiscard]] InvalidInput malformed_origin(const GltfJson::exception& error);

}  // namespace meshbound
