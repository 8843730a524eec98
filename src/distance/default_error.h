// SPDX-License-Identifier: MIT
#pragma once
#include "meshbound/mesh_summary.h"

namespace meshbound {

/// The default error bound of a distance, as a share of the size of the models.
inline constexpr double default_error_share = 1e-6;

/// That share of the diagonal of A's bounding box; where A is a point, of the one around both models, which
/// `box_of_both()` gives.
template <class BoxOfBoth>
[[nodiscard]] double default_error(double diagonal_of_a, const BoxOfBoth& box_of_both) {
  return default_error_share * (diagonal_of_a > 0 ? diagonal_of_a : diagonal_of(box_of_both()));
}

}  // namespace meshbound
