// SPDX-License-Identifier: MIT
/// Meshes whose coordinates are a few steps of the smallest double: distances between them have few bits, shares of
/// their size round to 0, and pieces would be cut for the sake of bounds that cannot be had. They are measured at 2^990
/// times their size, where all coordinates are exact and distances have all bits of doubles.
#pragma once
#include "meshbound/texture_deviation.h"

namespace meshbound {

/// Whether all corners of both meshes have coordinates below 2^-1000, not all of them 0. O(n).
[[nodiscard]] bool are_tiny(const TexturedMesh& a, const TexturedMesh& b);

/// As `texture_deviation`, for two meshes that are tiny.
[[nodiscard]] TextureDeviation deviation_of_tiny(const TexturedMesh& a, const TexturedMesh& b,
                                                 const TextureDeviationOptions& options);

}  // namespace meshbound
