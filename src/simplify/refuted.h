// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>

#include "numeric/no_index.h"

namespace meshbound {

/// What a measurement of the mesh has refuted, by number: a triangle of the original, the face that stands for it, or
/// both.
struct Refuted {
  std::uint32_t original = no_index, face = no_index;
};

}  // namespace meshbound
