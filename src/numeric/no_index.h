// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>

namespace meshbound {

/// The index of nothing: what a look-up returns that finds none. (Slots have 31 bits and a name of their own, `no_slot`
/// in bvh/bvh_data.h.)
inline constexpr std::uint32_t no_index = 0xffffffff;

}  // namespace meshbound
