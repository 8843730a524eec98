// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <optional>
#include <span>

#include "meshbound/bounds.h"
#include "meshbound/error.h"
#include "meshbound/mesh_view.h"

namespace meshbound {

/// Whether triangles keep their own tolerances, and where not.
struct FaceToleranceCheck {
  /// `Within`: proven. `Exceeds`: `original_triangle` has a point that is further from the simplified mesh than it may
  /// be. `Undecided`: neither, for the triangle that is named.
  Verdict verdict = Verdict::Within;
  std::optional<std::uint32_t> original_triangle;    ///< index of the one that exceeds or is undecided
  std::optional<std::uint32_t> simplified_triangle;  ///< index of the one that is undecided
};

/// Checks afresh, with nothing but the two meshes, that triangles of an original keep tolerances of their own:
///
///     every point of original triangle k lies within min(tolerance, tolerances[k]) of the simplified mesh, and
///     every point of the simplified mesh lies within min(tolerance, tolerances[g]) of the original triangle g nearest
///     to it.
///
/// The second is decided face by face, with the smallest tolerance of the originals around its bounding box: large
/// faces that reach from a coarse region into a fine one may be left undecided though they hold. Model units. Throws
/// `InvalidInput` for another number of tolerances, tolerances below 0, one for all that is not finite, and meshes that
/// `validate` refuses. Expected O(n log n). Safe to call from several threads.
[[nodiscard]] FaceToleranceCheck check_face_tolerances(const MeshView& original, std::span<const double> tolerances,
                                                       double tolerance, const MeshView& simplified);

}  // namespace meshbound
