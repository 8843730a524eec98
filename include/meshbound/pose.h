// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Geometry>

namespace meshbound {

/// A rigid motion, from model to world coordinates. `Eigen::Isometry3d` converts to it and back by itself.
///
/// Eigen aligns `Isometry3d` to 16, 32 or 64 bytes, as the instruction set of a translation unit has it (`-mavx`,
/// `-march=native`, `EIGEN_MAX_ALIGN_BYTES`, `EIGEN_DONT_VECTORIZE`), so a structure with one would differ between the
/// library and a program that is compiled with other flags. These two types have the alignment of a double whatever the
/// flags.
using Pose = Eigen::Transform<double, 3, Eigen::Isometry, Eigen::DontAlign>;

/// An affine map of space. `Eigen::Affine3d` and `Eigen::Isometry3d` convert to it by themselves. Aligned as `Pose`.
using AffineMap = Eigen::Transform<double, 3, Eigen::Affine, Eigen::DontAlign>;

}  // namespace meshbound
