// SPDX-License-Identifier: MIT
/// Points and triangles that are hard on the arithmetic of a distance: the same ones for the same seed, on any machine.
#pragma once
#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "reference/exact_distance.h"

namespace meshbound::reference {

/// Numbers that do not depend on the standard library's distributions.
class Random {
 public:
  explicit Random(std::uint32_t seed) : engine_(seed) {}
  double uniform(double low, double high) { return low + (high - low) * static_cast<double>(engine_()) / 4294967296.0; }
  int below(int n) { return static_cast<int>(engine_() % static_cast<std::uint32_t>(n)); }
  Eigen::Vector3d in_cube() {
    const double x = uniform(-1, 1), y = uniform(-1, 1), z = uniform(-1, 1);
    return {x, y, z};
  }
  double power_of_ten(double low, double high) { return std::pow(10.0, uniform(low, high)); }
  double sign() { return below(2) == 0 ? -1 : 1; }

 private:
  std::mt19937 engine_;
};

struct PointTriangleCase {
  Corners triangle;
  Eigen::Vector3d query;
};

/// Where the closest point is well defined: width that the bounds may have, in units of epsilon * (size of the triangle
/// + distance). Every constant of the engine's error model is rounded up; it must stay far below any tolerance.
inline constexpr double width_of_plain_cases = 0x1p10;

/// That width where a direction or a height is mostly rounding: points next to the surface, slivers, needles. The
/// bounds hold there too, but the closest point that the engine constructs may be this far from the true one.
inline constexpr double width_of_thin_cases = 0x1p13;

/// That width for a query so far away that the triangle is little more than a point beside the distance.
inline constexpr double width_of_far_cases = 0x1p15;

struct CaseFamily {
  const char* name;
  PointTriangleCase (*make)(Random&);
  int count;             ///< of the default run; the slow run takes a hundred times as many
  double allowed_width;  ///< see above
};

[[nodiscard]] const std::vector<CaseFamily>& case_families();

}  // namespace meshbound::reference
