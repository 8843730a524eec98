// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "simplify/mesh/array_mesh.h"
#include "simplify/mesh/refuted.h"
#include "simplify/normals/face_turns.h"

namespace meshbound {

/// What of `refuted` still turns too much after changes were undone: a triangle of the original compared with the face
/// that its sample belongs to, or with the one that was found to stand for it where that is nearer. Those that say
/// where the texture has moved are left out, and originals that are no face. `source_triangle` says of each face at the
/// start which of the `originals` it was. O(n).
[[nodiscard]] std::vector<Refuted> refuted_by_turns(const FaceTurns& turns, const ArrayMesh& mesh,
                                                    std::span<const std::uint32_t> source_triangle,
                                                    std::size_t originals, std::span<const Refuted> refuted);

}  // namespace meshbound
