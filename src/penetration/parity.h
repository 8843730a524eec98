// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <vector>

#include "penetration/placed_pair.h"

namespace meshbound {

/// For each component of the other side's model, whether a vertex of one side lies inside it, by the parity of the
/// component's triangles above the vertex in world coordinates. Side 0 is moved by the infinitesimal vector of
/// `PlacedPair`, so no vertex lies on the surface, nor above or below an edge. O(n).
[[nodiscard]] std::vector<bool> components_around(PlacedPair& pair, PairVertex v);

/// Whether a vertex of one side lies inside the solid of the other. O(n).
[[nodiscard]] bool is_inside(PlacedPair& pair, PairVertex v);

/// False where a vertex of the component lies outside the box of the other side's model, so that the component cannot
/// be inside it. O(1).
[[nodiscard]] bool may_be_inside(const PlacedPair& pair, std::uint32_t side, std::uint32_t component);

}  // namespace meshbound
