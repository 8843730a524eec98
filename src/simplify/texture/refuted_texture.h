// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "simplify/mesh/array_mesh.h"
#include "simplify/mesh/refuted.h"
#include "simplify/texture/texture_map.h"

namespace meshbound {

/// What of `refuted` the texture still refutes after changes were undone, as far as the faces show that this has
/// changed: a point of the original needs one of them near it with its coordinate, and none of them may have the
/// coordinate far from all such points. O((refuted + faces) log faces) expected.
[[nodiscard]] std::vector<Refuted> refuted_by_texture(const TextureMap& texture, const ArrayMesh& mesh,
                                                      std::span<const Refuted> refuted,
                                                      std::span<const std::uint32_t> changed);

}  // namespace meshbound
