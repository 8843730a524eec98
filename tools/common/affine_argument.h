// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Geometry>
#include <string>

#include "meshbound/pose.h"

namespace meshbound::tools {

/// An affine map from the command line: 16 numbers in row-major order, separated by blanks, commas or semicolons, given
/// in the argument itself or in the file that it names. Throws `InvalidInput`, naming `option`, unless there are
/// exactly 16 finite numbers, the last four 0 0 0 1; `IoError` when the file cannot be read.
[[nodiscard]] AffineMap parse_affine(const std::string& option, const std::string& numbers_or_file);

/// The map of 16 numbers, row-major. Throws `InvalidInput`, beginning with `where`.
[[nodiscard]] AffineMap parse_affine_numbers(const std::string& where, const std::string& text);

}  // namespace meshbound::tools
