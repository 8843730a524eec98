// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <vector>

#include "bvh/bvh_data.h"

namespace meshbound {

/// Clears `alive` for each triangle (slot) of A whose three corners are, bit for bit and in any order, those of a
/// triangle of B. Both trees must have the same frame. Returns how many there were. By tasks
/// (numeric/tasks.h); O(n).
std::uint64_t drop_identical_triangles(const Bvh::Data& a, const Bvh::Data& b, std::vector<std::uint8_t>& alive);

/// Whether two triangles have the same corners, bit for bit and in any order; -0 and 0 are one position.
bool same_triangle(const Bvh::Data& a, const Triangle& t, const Bvh::Data& b, const Triangle& u);

/// A slot that uses a vertex. Vertices are numbered by first use along the slots, so it is looked for outward from the
/// proportional slot: few steps as a rule, O(n) at worst.
std::uint32_t slot_using_vertex(const Bvh::Data& data, std::uint32_t vertex);

}  // namespace meshbound
