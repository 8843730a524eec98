// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "deviation/colour_map.h"

namespace meshbound::tools {

/// Rows of pixels.
class Picture {
 public:
  Picture(int width, int height, const Colour& background);

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] const Colour& at(int x, int y) const { return pixels_[index(x, y)]; }
  void set(int x, int y, const Colour& colour) { pixels_[index(x, y)] = colour; }

  /// Writes a text in UTF-8 in capitals 7 pixels high times `size`, 6 wide for each code point; its upper left corner
  /// is at (x, y). Code points that the font lacks are boxes, and parts outside the picture are not drawn.
  void write(int x, int y, std::string_view text, const Colour& colour, int size = 1);
  /// The width of what `write` draws, with the gap behind the last code point; pixels.
  [[nodiscard]] static int text_width(std::string_view text, int size = 1);
  /// Fills a rectangle with its upper left corner at (x, y); pixels outside the picture are left out.
  void fill(int x, int y, int width, int height, const Colour& colour);
  /// The picture at half its width and height, each pixel the mean of four.
  [[nodiscard]] Picture halved() const;
  /// The bytes of a PNG file. Throws `Error` where libpng does not make one.
  [[nodiscard]] std::string png() const;

 private:
  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }
  int width_, height_;
  std::vector<Colour> pixels_;
};

}  // namespace meshbound::tools
