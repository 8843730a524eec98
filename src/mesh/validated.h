// SPDX-License-Identifier: MIT
#pragma once
#include "meshbound/mesh_view.h"
#include "meshbound/triangle_mesh.h"

namespace meshbound {

/// The mesh itself once `validate` accepts it, for members that are initialised from it. Throws as `validate`.
inline const TriangleMesh& validated(const TriangleMesh& mesh) {
  validate(mesh);
  return mesh;
}

}  // namespace meshbound
