// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Core>

#include "geometry/vec3.h"

namespace meshbound {

[[nodiscard]] inline Vec3 to_vec3(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }
[[nodiscard]] inline Eigen::Vector3d to_eigen(const Vec3& p) { return {p.x, p.y, p.z}; }

}  // namespace meshbound
