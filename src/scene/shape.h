// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <optional>
#include <vector>

#include "meshbound/similarity.h"

namespace meshbound {

/// The lowest and highest coordinate along three axes.
struct Extents {
  std::array<double, 3> lo, hi;
};

struct Shape::Impl {
  TriangleMesh mesh;  ///< normalised; empty once the tree is built
  Eigen::Affine3d normalisation;
  Eigen::Matrix3d axes;
  Extents along_world;                   ///< along x, y and z
  Extents along_axes;                    ///< along the principal axes
  std::vector<Eigen::Vector3d> samples;  ///< a few vertices, normalised
  BvhOptions tree_options;
  std::optional<Bvh> tree;
};

}  // namespace meshbound
