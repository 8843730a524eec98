// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Core>
#include <cmath>

namespace meshbound {

/// The length of a vector whose squares may be no numbers: at most 4 roundings off, relative. `std::hypot` of three
/// numbers is the square root of a plain sum of squares in some standard libraries (libc++ of LLVM 14, WebAssembly).
inline double safe_length(const Eigen::Vector3d& v) {
  const double largest = v.cwiseAbs().maxCoeff();
  if (largest == 0) return 0;
  const double x = v.x() / largest, y = v.y() / largest, z = v.z() / largest;
  return largest * std::sqrt(x * x + y * y + z * z);
}

}  // namespace meshbound
