// SPDX-License-Identifier: MIT
/// Checks of numbers on the command line: what is wrong with a text as such a number; empty if it is one.
#pragma once
#include <string>

namespace meshbound::tools {

[[nodiscard]] std::string number_of_seconds(const std::string& text);
/// A number of degrees is that of an angle, from 0 to 180.
[[nodiscard]] std::string number_of_degrees(const std::string& text);
[[nodiscard]] std::string number_of_faces(const std::string& text);
/// A number of texels is that of a side of a texture, above 0.
[[nodiscard]] std::string number_of_texels(const std::string& text);

}  // namespace meshbound::tools
