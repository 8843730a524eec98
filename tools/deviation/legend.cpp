// SPDX-License-Identifier: MIT
#include "deviation/legend.h"

#include <algorithm>

#include "common/length.h"

namespace meshbound::tools {
namespace {

// Pixels.
constexpr int bar_margin = 8;  // above and below the bar
constexpr int bar_height = 20;
constexpr int beyond_width = 60;  // of the field in the colour for deviations beyond
constexpr int gap = 12;

/// The smallest text that can be read in the halved picture.
constexpr int small_text_size = 2;

/// The text at the end of the scale, and its size.
struct EndText {
  std::string text;
  int size = text_size;

  [[nodiscard]] int width() const { return Picture::text_width(text, size); }
};

std::string text_with(const DeviationScale& scale, const std::string& unit) {
  return short_number(scale.end) + (unit.empty() ? "" : " " + unit) + ": " + scale.meaning + ", beyond:";
}

/// Drops the last code point of a text in UTF-8, which is not empty.
void drop_last(std::string& text) {
  while (text.size() > 1 && (static_cast<unsigned char>(text.back()) & 0xC0) == 0x80) text.pop_back();
  text.pop_back();
}

/// What fits into `room` pixels.
EndText end_text(const DeviationScale& scale, std::string unit, int room) {
  constexpr std::size_t max_unit_size = 512;  // bytes; far more than fit, and soon cut
  unit.resize(std::min(unit.size(), max_unit_size));
  EndText end{text_with(scale, unit)};
  if (end.width() > room) end.size = small_text_size;
  while (end.width() > room && !unit.empty()) {
    drop_last(unit);
    end.text = text_with(scale, unit + "...");
  }
  return end;
}

}  // namespace

void draw_legend(Picture& picture, int left, int top, int width, const DeviationScale& scale, const std::string& unit) {
  const int first = left + gap, y = top + bar_margin, bar = width - beyond_width - 3 * gap, last = first + bar;
  for (int x = 0; x < bar; ++x)
    picture.fill(first + x, y, 1, bar_height, colour_of(static_cast<double>(x) / (bar - 1)));
  picture.fill(last + gap, y, beyond_width, bar_height, colour_beyond);
  const int text_y = y + bar_height + bar_margin;
  picture.write(first, text_y, "0", ink, text_size);
  const EndText end = end_text(scale, unit, bar - Picture::text_width("0", text_size) - gap);
  picture.write(last + gap - end.width(), text_y, end.text, ink, end.size);
}

}  // namespace meshbound::tools
