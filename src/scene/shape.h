// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "meshbound/pose.h"
#include "meshbound/similarity.h"

namespace meshbound {

/// The lowest and highest coordinate along three axes.
struct Extents {
  std::array<double, 3> lo, hi;
};

/// Vertices of a shape that are looked at before it is measured: first a few of them, then all.
inline constexpr std::size_t few_samples = 16, max_samples = 128;

struct Shape::Impl {
  TriangleMesh mesh;  ///< normalised; empty once the tree is built
  AffineMap normalisation;
  Eigen::Matrix3d axes;
  Extents along_world;                   ///< along x, y and z
  Extents along_axes;                    ///< along the principal axes
  std::vector<Eigen::Vector3d> samples;  ///< vertices, normalised; at most `max_samples`
  BvhOptions tree_options;
  std::optional<Bvh> tree;
};

}  // namespace meshbound
