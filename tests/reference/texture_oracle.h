// SPDX-License-Identifier: MIT
/// Texture deviation in rational arithmetic, by brute force: the oracle for `texture_deviation`, with which it shares
/// no code.
#pragma once
#include <gmpxx.h>

#include <array>
#include <optional>

#include "meshbound/texture_deviation.h"

namespace meshbound::reference {

using RationalWeights = std::array<mpq_class, 3>;  ///< barycentric, of sum 1

/// The squared distance from the point of `a` with these weights to the nearest point of `mesh` that has its texture
/// coordinate; none where no point has. O(n).
[[nodiscard]] std::optional<mpq_class> squared_deviation_at(const TexturedTriangle& a, const RationalWeights& weights,
                                                            const TexturedMesh& mesh);

/// The largest squared distance at a corner of what a triangle of `b` covers of a triangle of `a`, over all pairs that
/// meet in an area: the square of T(A, B) where triangles of `b` do not overlap in the texture, and no triangle of `a`
/// meets them in a line or point alone. With touches, over all pairs that meet at all: never below the square of T(A,
/// B) where all triangles have an area in the texture. O(n m).
[[nodiscard]] mpq_class squared_deviation_of_charts(const TexturedMesh& a, const TexturedMesh& b,
                                                    bool with_touches = false);

/// Whether the triangle has an area in the texture.
[[nodiscard]] bool has_area_in_texture(const TexturedTriangle& triangle);

/// The share of a triangle's area that no triangle of `mesh` covers, where these do not overlap in the texture.
[[nodiscard]] mpq_class uncovered_share(const TexturedTriangle& a, const TexturedMesh& mesh);

/// Sign of root(squared) - length.
[[nodiscard]] int compare_root(const mpq_class& squared, double length);

}  // namespace meshbound::reference
