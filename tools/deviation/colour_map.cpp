// SPDX-License-Identifier: MIT
#include "deviation/colour_map.h"

#include <algorithm>
#include <cmath>

namespace meshbound::tools {
namespace {

constexpr std::array<Colour, 10> viridis = {{{68, 1, 84},
                                             {72, 40, 120},
                                             {62, 73, 137},
                                             {49, 104, 142},
                                             {38, 130, 142},
                                             {31, 158, 137},
                                             {53, 183, 121},
                                             {110, 206, 88},
                                             {181, 222, 43},
                                             {253, 231, 37}}};

}  // namespace

std::span<const Colour> colour_stops() { return viridis; }

Colour colour_of(double share) {
  if (!(share <= 1)) return colour_beyond;
  const double stop = std::max(0.0, share) * static_cast<double>(viridis.size() - 1);
  const std::size_t below = std::min(viridis.size() - 2, static_cast<std::size_t>(stop));
  const double part = stop - static_cast<double>(below);
  Colour colour;
  for (std::size_t k = 0; k < colour.size(); ++k)
    colour[k] = static_cast<std::uint8_t>(std::lround((1 - part) * viridis[below][k] + part * viridis[below + 1][k]));
  return colour;
}

}  // namespace meshbound::tools
