// SPDX-License-Identifier: MIT
#pragma once
#include <vector>

#include "meshbound/texture_deviation.h"
#include "texture/approximate.h"

namespace meshbound {

/// What is known of the textured triangles of a mesh A, compared with a mesh B.
struct TriangleBounds {
  /// By triangle: an upper bound of the deviation over the points whose texture coordinates B covers, model units; -1:
  /// there are none; infinite: nothing is known.
  std::vector<double> upper;
  std::vector<Approximate> uncovered;  ///< by triangle with a finite bound: the share of it that B does not cover
};

/// The bounds of A compared with B that need no measurement: triangles that B has as well have a deviation of 0.
/// Expected O(n log n).
[[nodiscard]] TriangleBounds bounds_of_equal(const TexturedMesh& a, const TexturedMesh& b);

/// The bounds that `known`, those of A compared with B, leaves for another A compared with another B: of the triangles
/// that are in both A, where the same triangles of both B may have their texture coordinates, or all that changes lies
/// farther away in space than matters. Expected O(n log n).
[[nodiscard]] TriangleBounds bounds_left(const TriangleBounds& known, const TexturedMesh& a, const TexturedMesh& b,
                                         const TexturedMesh& new_a, const TexturedMesh& new_b);

}  // namespace meshbound
