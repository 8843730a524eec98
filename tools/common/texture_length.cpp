// SPDX-License-Identifier: MIT
#include "common/texture_length.h"

#include <cmath>

#include "meshbound/error.h"

namespace meshbound::tools {

double TextureLength::in_model_units(double diagonal, double texel_length) const {
  if (!is_in_texels) return length.in_model_units(diagonal);
  if (!(texel_length > 0) || !std::isfinite(texel_length))
    throw InvalidInput(
        "no triangle has an area on the surface and in the texture, so a texel has no size there; give a length");
  return texels * texel_length;
}

TextureLength parse_texture_length(const std::string& option, const std::string& text, bool has_texture_size) {
  for (const std::string unit : {"texels", "texel"}) {
    if (text.size() <= unit.size() || !text.ends_with(unit)) continue;
    if (!has_texture_size)
      throw InvalidInput(option + ": '" + text + "' needs --texture-size, the texels of a side of the texture");
    const Length number = parse_length(option, text.substr(0, text.size() - unit.size()));
    if (number.is_percentage) throw InvalidInput(option + ": '" + text + "' is no number of texels");
    return {{}, number.value, true};
  }
  return {parse_length(option, text)};
}

}  // namespace meshbound::tools
