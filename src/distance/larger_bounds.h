// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>

#include "meshbound/bounds.h"

namespace meshbound {

/// Bounds of the larger of two lengths.
[[nodiscard]] inline Bounds larger(const Bounds& x, const Bounds& y) {
  return {std::max(x.lower, y.lower), std::max(x.upper, y.upper)};
}

}  // namespace meshbound
