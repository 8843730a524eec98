// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstdint>

namespace meshbound {

/// Index of a cell of the 2^bits grid along the Hilbert curve: cells that follow each other share a face, so runs of
/// the order make compact boxes. After Hamilton, "Compact Hilbert Indices", Dalhousie CS-2006-07, as a table over its
/// 24 states of (entry corner, direction). `bits` <= 21.
std::uint64_t hilbert_index(std::uint32_t x, std::uint32_t y, std::uint32_t z, int bits);

}  // namespace meshbound
