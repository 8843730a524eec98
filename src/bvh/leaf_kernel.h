// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>

#include "bvh/bvh_data.h"

namespace meshbound {

/// Fills the lowest nodes of a tree from `begin` to below `end`, and the normals of the triangles in their blocks: each
/// corner is fetched once for both.
using BuildLeaves = void (*)(Bvh::Data& data, std::size_t begin, std::size_t end);

/// The fastest implementation that this machine runs, and the one that any machine runs. Both give the same bits.
[[nodiscard]] BuildLeaves leaf_kernel();
[[nodiscard]] BuildLeaves portable_leaf_kernel();

}  // namespace meshbound
