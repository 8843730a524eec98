// SPDX-License-Identifier: MIT
#pragma once
#include "mesh/mesh_source.h"
#include "meshbound/io.h"

namespace meshbound {

// One reader per format. Each throws `InvalidInput` for what is malformed; see `read_mesh`.
[[nodiscard]] MeshFile read_off(const MeshSource& source);
[[nodiscard]] MeshFile read_obj(const MeshSource& source);
[[nodiscard]] MeshFile read_ply(const MeshSource& source);
[[nodiscard]] MeshFile read_stl(const MeshSource& source);

}  // namespace meshbound
