// SPDX-License-Identifier: MIT
#include "deviation/picture.h"

#include <png.h>

#include <algorithm>

#include "common/utf8.h"
#include "deviation/font.h"
#include "meshbound/error.h"

namespace meshbound::tools {
namespace {

constexpr int advance = 6;  // pixels from one code point to the next, at size 1

}  // namespace

Picture::Picture(int width, int height, const Colour& background)
    : width_(width),
      height_(height),
      pixels_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), background) {}

void Picture::fill(int x, int y, int width, int height, const Colour& colour) {
  for (int row = std::max(0, y); row < std::min(height_, y + height); ++row)
    for (int column = std::max(0, x); column < std::min(width_, x + width); ++column) set(column, row, colour);
}

void Picture::write(int x, int y, std::string_view text, const Colour& colour, int size) {
  for (const char32_t letter : code_points(text)) {
    const Glyph glyph = glyph_of(letter);
    for (int row = 0; row < 7; ++row)
      for (int column = 0; column < 5; ++column)
        if ((glyph[static_cast<std::size_t>(row)] >> (4 - column) & 1) != 0)
          fill(x + column * size, y + row * size, size, size, colour);
    x += advance * size;
  }
}

int Picture::text_width(std::string_view text, int size) {
  return advance * size * static_cast<int>(code_points(text).size());
}

Picture Picture::halved() const {
  Picture half(width_ / 2, height_ / 2, {});
  for (int y = 0; y < half.height_; ++y) {
    for (int x = 0; x < half.width_; ++x) {
      Colour mean;
      for (std::size_t k = 0; k < mean.size(); ++k)
        mean[k] = static_cast<std::uint8_t>((at(2 * x, 2 * y)[k] + at(2 * x + 1, 2 * y)[k] + at(2 * x, 2 * y + 1)[k] +
                                             at(2 * x + 1, 2 * y + 1)[k] + 2) /
                                            4);
      half.set(x, y, mean);
    }
  }
  return half;
}

std::string Picture::png() const {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width_);
  image.height = static_cast<png_uint_32>(height_);
  image.format = PNG_FORMAT_RGB;
  std::string bytes(PNG_IMAGE_PNG_SIZE_MAX(image), '\0');
  png_alloc_size_t size = bytes.size();
  if (png_image_write_to_memory(&image, bytes.data(), &size, 0, pixels_.data(), 0, nullptr) == 0)
    throw Error(std::string("the picture cannot be encoded as PNG: ") + image.message);
  bytes.resize(size);
  return bytes;
}

}  // namespace meshbound::tools
