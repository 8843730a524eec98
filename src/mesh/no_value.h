// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>

#include "meshbound/attributes.h"

namespace meshbound {

/// Index of a corner without a value.
inline constexpr std::uint32_t no_value = CornerAttribute::none;
/// Indices of a triangle without values.
inline constexpr Triangle no_values = {no_value, no_value, no_value};

/// Whether all corners of a triangle have values; `indices` are those of the values.
[[nodiscard]] inline bool all_have_values(const Triangle& indices) {
  return std::find(indices.begin(), indices.end(), no_value) == indices.end();
}

}  // namespace meshbound
