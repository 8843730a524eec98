// SPDX-License-Identifier: MIT
#pragma once
#include "meshbound/screen_space.h"

namespace meshbound::tools {

/// What an error may cover on a screen, unless it is said otherwise a pixel of a usual one.
struct PixelLimit {
  double pixels = 1;
  double screen_height = Screen().height_pixels;  ///< pixels
};

/// The vertical field of view where none is said, degrees.
inline constexpr double default_fov = 60;

}  // namespace meshbound::tools
