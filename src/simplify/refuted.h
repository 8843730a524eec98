// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <cstdint>

#include "numeric/no_index.h"

namespace meshbound {

/// What a measurement of the mesh has refuted, by number: a triangle of the original, the face that stands for it, or
/// both.
struct Refuted {
  std::uint32_t original = no_index, face = no_index;
};

/// How far to go back where a measurement has refuted something.
struct TakeBack {
  /// So many of the last changes of each face that is blamed are undone.
  std::size_t depth = 1;
  /// Nothing that comes back is changed again. Otherwise only what led to it is not made again.
  bool stays_as_it_is = false;
};

}  // namespace meshbound
