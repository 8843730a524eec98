// SPDX-License-Identifier: MIT
/// Hausdorff distances by dense sampling with a covering radius: the oracle for the engine's search, with which it
/// shares no code. Every triangle of A is split into four until each piece is proven, by |d(x) - d(y)| <= |x - y|
/// alone, to hold no point further from B than the best sample found plus `width`.
#pragma once
#include "meshbound/bounds.h"
#include "meshbound/mesh_view.h"

namespace meshbound::reference {

/// What plain double arithmetic may get wrong here, as a fraction of the largest coordinate: a thousand times more than
/// what triangles of aspect below 1e6 cost.
inline constexpr double brute_force_allowance = 1e-9;

/// Time O(|A| (size / width)^2 |B|) where the distance is flat, far less elsewhere. For small meshes.
[[nodiscard]] Bounds brute_force_one_sided(const MeshView& a, const MeshView& b, double width);
[[nodiscard]] Bounds brute_force_symmetric(const MeshView& a, const MeshView& b, double width);

}  // namespace meshbound::reference
