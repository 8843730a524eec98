// SPDX-License-Identifier: MIT
#include "common/texture_length.h"

#include "meshbound/error.h"

namespace meshbound::tools {

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
