// SPDX-License-Identifier: MIT
#pragma once
#include <span>

#include "meshbound/bounds.h"
#include "meshbound/texture_deviation.h"
#include "texture/approximate.h"

namespace meshbound {

/// The share of the area of a mesh that `shares` of its textured triangles are, and all of its bare ones.
[[nodiscard]] Bounds uncovered_share_of(const TexturedMesh& mesh, std::span<const Approximate> shares);

}  // namespace meshbound
