// SPDX-License-Identifier: MIT
#pragma once
#include "geometry/vec3.h"

namespace meshbound {

/// The square of a shorter vector may be no normal number, and its computed length is then off by more than a rounding.
inline constexpr double least_accurate_length = 0x1p-500;

/// The vector with the length 1, up to a few roundings; 0 where the length that it has is not accurate.
[[nodiscard]] inline Vec3 unit(Vec3 v) {
  const double size = length(v);
  return size > least_accurate_length ? (1 / size) * v : Vec3{};
}

}  // namespace meshbound
