// SPDX-License-Identifier: MIT
#include "decimation/texture_tolerance.h"

#include "meshbound/error.h"

namespace meshbound::tools {

TextureTolerance parse_texture_tolerance(const std::string& text, bool has_texture_size) {
  const std::string option = "--texture-tolerance";
  if (text.size() < 2 || !text.ends_with('x')) return {parse_texture_length(option, text, has_texture_size), {}};
  const Length number = parse_length(option, text.substr(0, text.size() - 1));
  if (number.is_percentage)
    throw InvalidInput(option + ": '" + text + "' is no multiple of the tolerance, such as 1x or 0.5x");
  return {{}, number.value};
}

}  // namespace meshbound::tools
