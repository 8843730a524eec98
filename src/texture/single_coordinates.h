// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "meshbound/texture_deviation.h"
#include "texture/charts.h"

namespace meshbound {

/// Triangles of A that have one texture coordinate, the same for all: as those of one colour of a palette.
struct SingleCoordinate {
  std::vector<std::uint32_t> triangles;  ///< of A
  /// By triangle: no point of it is further than this from a triangle of B that has that coordinate only, model units.
  std::vector<double> upper;
  /// A lower bound of their texture deviation, and where it was found. Absent where triangles of B may have that
  /// coordinate among others: these may be nearer.
  std::optional<double> lower;
  TextureWitness witness;
};

/// The distances of triangles of A that have one texture coordinate to all of B that have the same one, by the engine
/// for Hausdorff distances. Of the triangles in `wanted`, those for which B has such triangles. They are told apart
/// where one of them is beyond the tolerance, if there is one. Throws `Stopped`. Expected O((n + m) log m).
[[nodiscard]] std::vector<SingleCoordinate> distances_at_single_coordinates(const Charts& a, const Charts& b,
                                                                            std::span<const std::size_t> wanted,
                                                                            double error_bound,
                                                                            const TextureDeviationOptions& options);

}  // namespace meshbound
