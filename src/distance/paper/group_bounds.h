// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <array>

#include "bvh/nearest.h"

namespace meshbound {

/// What is known of h(T, B) after some triangles of B. The lower bound is one only after all that can matter.
struct GroupBounds {
  std::array<Nearest, 3> nearest;  ///< closest triangle of each corner (Eq. 13)
  Nearest upper;                   ///< the triangle of B whose furthest corner of T is nearest (Eq. 12)

  [[nodiscard]] std::size_t worst_corner() const {
    const auto nearer = [](const Nearest& x, const Nearest& y) { return x.squared < y.squared; };
    return static_cast<std::size_t>(std::max_element(nearest.begin(), nearest.end(), nearer) - nearest.begin());
  }
};

}  // namespace meshbound
