// SPDX-License-Identifier: MIT
#pragma once
#include <string>

#include "common/length.h"

namespace meshbound::tools {

/// A tolerance of texture deviation as typed: a length, or a number of texels, "2texels".
struct TextureLength {
  Length length;
  double texels = 0;
  bool is_in_texels = false;

  /// `texel_length` as the function of that name gives it. Throws `InvalidInput` where a texel has no size.
  [[nodiscard]] double in_model_units(double diagonal, double texel_length) const;
};

/// Throws `InvalidInput`, naming `option`, for text that is neither a length nor a number of texels, and for texels
/// without a texture size.
[[nodiscard]] TextureLength parse_texture_length(const std::string& option, const std::string& text,
                                                 bool has_texture_size);

}  // namespace meshbound::tools
