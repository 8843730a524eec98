// SPDX-License-Identifier: MIT
#pragma once
#include <string>

#include "mesh/gltf_value.h"
#include "meshbound/attributes.h"

namespace meshbound {

/// What is written to a file: its JSON and the bytes of its one buffer, which may have none.
struct GltfContent {
  GltfJson json;
  std::string bytes;
};

/// The document that the mesh was read from, with the triangles of `mesh` in place of its own; a new one where there is
/// none. Throws `InvalidInput` where a document is malformed in what no reader of triangles looks at.
[[nodiscard]] GltfContent gltf_content(const TriangleMesh& mesh, const MeshAttributes& attributes);

}  // namespace meshbound
