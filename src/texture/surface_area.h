// SPDX-License-Identifier: MIT
#pragma once
#include <span>

#include "meshbound/bounds.h"
#include "meshbound/texture_deviation.h"
#include "texture/approximate.h"

namespace meshbound {

/// Which share of the area of a mesh is uncovered: of each textured triangle the part given by `shares`, and all
/// triangles without texture coordinates.
[[nodiscard]] Bounds uncovered_share_of(const TexturedMesh& mesh, std::span<const Approximate> shares);

}  // namespace meshbound
