// SPDX-License-Identifier: MIT
#pragma once
#include "meshbound/attributes.h"

namespace meshbound {

/// Index of a corner without a value.
inline constexpr std::uint32_t no_value = CornerAttribute::none;

}  // namespace meshbound
