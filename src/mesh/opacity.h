// SPDX-License-Identifier: MIT
/// The fourth number of colours, for formats without it.
#pragma once
#include <vector>

#include "meshbound/attributes.h"

namespace meshbound {

/// The number of colours whose opacity is not 1.
[[nodiscard]] inline std::size_t count_translucent(const NamedAttribute& colours) {
  std::size_t count = 0;
  for (std::size_t i = 3; colours.width == 4 && i < colours.values.size(); i += 4) count += colours.values[i] != 1;
  return count;
}

/// Leaves only red, green and blue.
inline void remove_opacity(NamedAttribute& colours) {
  if (colours.width != 4) return;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < colours.values.size(); ++i)
    if (i % 4 != 3) colours.values[kept++] = colours.values[i];
  colours.values.resize(kept);
  colours.width = 3;
}

}  // namespace meshbound
