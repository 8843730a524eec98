// SPDX-License-Identifier: MIT
#pragma once
#include <optional>
#include <string>

#include "common/texture_length.h"

namespace meshbound::tools {

/// --texture-tolerance as typed: a length, or a multiple of the tolerance of each level, "1x".
struct TextureTolerance {
  TextureLength length;
  std::optional<double> multiple;

  /// How far the texture of a level may move, model units: `tolerance` is that of the level, `texel_length` the side of
  /// a texel on the surface, as the function of that name gives it.
  [[nodiscard]] double of_level(double tolerance, double diagonal, double texel_length) const {
    return multiple ? *multiple * tolerance : length.in_model_units(diagonal, texel_length);
  }
};

/// Throws `InvalidInput` for text that is neither, and for texels without a texture size.
[[nodiscard]] TextureTolerance parse_texture_tolerance(const std::string& text, bool has_texture_size);

}  // namespace meshbound::tools
