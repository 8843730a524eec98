// SPDX-License-Identifier: MIT
/// Checks of numbers on the command line: what is wrong with a text as such a number; empty if it is one.
#pragma once
#include <string>

namespace meshbound::tools {

[[nodiscard]] std::string number_of_seconds(const std::string& text);
/// Of an angle, from 0 to 180.
[[nodiscard]] std::string number_of_degrees(const std::string& text);
[[nodiscard]] std::string number_of_faces(const std::string& text);
/// Of a side of a texture.
[[nodiscard]] std::string number_of_texels(const std::string& text);

}  // namespace meshbound::tools
