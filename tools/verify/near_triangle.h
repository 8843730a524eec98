// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Core>
#include <array>

#include "verify/numbers.h"

namespace meshbound::verify {

using Corners = std::array<Eigen::Vector3d, 3>;

/// True proves that every point of the box `p` is within `tolerance` of the triangle, in real arithmetic; false says
/// nothing. The triangle may be a segment or a point.
[[nodiscard]] bool surely_near(const Vec<Interval>& p, const Corners& triangle, double tolerance);

/// Whether p is within `tolerance` of the triangle, exactly.
[[nodiscard]] bool is_near(const Vec<Exact>& p, const Corners& triangle, double tolerance);

}  // namespace meshbound::verify
