// SPDX-License-Identifier: MIT
/// Why a run ended that several decimations make together: groups of a scene, tiles of a mesh.
#pragma once
#include <algorithm>

#include "meshbound/simplify.h"

namespace meshbound {

/// The reason to name where one decimation ended by `a` and another one by `b`: the later in the enumeration, but
/// `Rounding`, by which nothing was collapsed, only where both ended by it. So `Rounding` is what no decimation at all
/// ends by.
[[nodiscard]] inline EndedBy joint_reason(EndedBy a, EndedBy b) {
  if (a == EndedBy::Rounding) return b;
  if (b == EndedBy::Rounding) return a;
  return std::max(a, b);
}

}  // namespace meshbound
