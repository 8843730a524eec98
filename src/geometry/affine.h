// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Core>
#include <string>
#include <string_view>

#include "meshbound/error.h"

namespace meshbound {

/// Throws `InvalidInput`, whose text begins with `what`, for a matrix that is no affine map: Eigen does not look at its
/// last row, where a transposed matrix has the translation.
inline void require_affine(const Eigen::Matrix4d& matrix, std::string_view what) {
  if (!matrix.allFinite()) throw InvalidInput(std::string(what) + " has an entry that is not finite");
  if (matrix.row(3) != Eigen::RowVector4d(0, 0, 0, 1))
    throw InvalidInput(std::string(what) + " has a last row that is not 0 0 0 1: is it transposed?");
}

}  // namespace meshbound
