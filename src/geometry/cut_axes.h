// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstddef>

#include "geometry/vec3.h"

namespace meshbound {

/// Number of directions in which a mesh can be cut into pieces by planes.
inline constexpr int cut_directions = 3;

/// The axes that a cut runs across, by direction: orthogonal, with components that are multiples of 1, 1/3 or 1/7.
/// Planes of different directions share lines at most, where planes along the same axes through the middles of a
/// symmetric mesh would be the same ones.
inline constexpr std::array<std::array<Vec3, 3>, cut_directions> cut_axes = {{{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
                                                                              {{{2, 2, 1}, {-2, 1, 2}, {1, -2, 2}}},
                                                                              {{{6, 2, 3}, {-3, 6, 2}, {2, 3, -6}}}}};

}  // namespace meshbound
