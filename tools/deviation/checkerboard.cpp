// SPDX-License-Identifier: MIT
#include "deviation/checkerboard.h"

#include <cmath>

namespace meshbound::tools {

Colour checkerboard_at(const CornerAttribute& texture, std::uint32_t triangle, const Eigen::Vector3d& weights,
                       const Colour& otherwise) {
  if (triangle >= texture.index.size()) return otherwise;
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t value = texture.index[triangle][k];
    if (value == CornerAttribute::none) return otherwise;
    at += weights[static_cast<Eigen::Index>(k)] * texture.values[value].head<2>();
  }
  if (!at.allFinite()) return otherwise;
  const Eigen::Vector2d square = (squares_per_unit * at).array().floor(), in_unit = at.array() - at.array().floor();
  constexpr double light = 1, dark = 0.55, least = 90, range = 150;  // of the light; of the channels, 0 to 255
  const double brightness = std::fmod(std::fabs(square.sum()), 2) == 1 ? dark : light;
  const auto channel = [&](double share) {
    return static_cast<std::uint8_t>(std::lround(brightness * (least + range * share)));
  };
  return {channel(in_unit.x()), channel(1 - in_unit.x()), channel(in_unit.y())};
}

}  // namespace meshbound::tools
