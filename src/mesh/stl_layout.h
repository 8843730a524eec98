// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>

namespace meshbound {

/// Where things are in binary STL, in bytes: a header of any text but "solid", the number of triangles, and a record
/// for each of them: its normal, three corners and two bytes of attributes.
inline constexpr std::size_t stl_count_offset = 80, stl_records_offset = 84, stl_record_size = 50;

}  // namespace meshbound
