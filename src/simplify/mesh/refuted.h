// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "numeric/no_index.h"

namespace meshbound {

/// What a measurement of the mesh has refuted, by number: a triangle of the original, the face that stands for it, or
/// both.
struct Refuted {
  std::uint32_t original = no_index, face = no_index;
  /// Where the texture has moved too far: a texture coordinate of that triangle and of the face.
  std::optional<Eigen::Vector2d> coordinate = std::nullopt;
};

}  // namespace meshbound
