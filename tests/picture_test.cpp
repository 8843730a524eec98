// SPDX-License-Identifier: MIT
// What is written into pictures: units in UTF-8, boxes for what the font lacks, and a legend whose texts stay apart.
#include "deviation/picture.h"

#include <gtest/gtest.h>

#include <string>

#include "common/utf8.h"
#include "deviation/font.h"
#include "deviation/legend.h"

namespace meshbound {
namespace picture_test {

using namespace tools;

constexpr Colour white = {255, 255, 255}, black = {0, 0, 0};

/// The pixels of a text, row by row, as spaces and signs.
std::string drawn(const std::string& text) {
  Picture picture(Picture::text_width(text), 7, white);
  picture.write(0, 0, text, black);
  std::string pixels;
  for (int y = 0; y < picture.height(); ++y, pixels += '\n')
    for (int x = 0; x < picture.width(); ++x) pixels += picture.at(x, y) == black ? '#' : ' ';
  return pixels;
}

TEST(Utf8, IsDecodedAndWhatIsNoneIsReplaced) {
  EXPECT_EQ(code_points("mm \u00B5 \u2033 \U0001F4CF"), U"mm \u00B5 \u2033 \U0001F4CF");
  EXPECT_EQ(code_points(""), U"");
  EXPECT_EQ(code_points("\xB5m"), U"\uFFFDm") << "Latin-1";
  EXPECT_EQ(code_points("a\xE2\x80"), U"a\uFFFD\uFFFD") << "cut off";
  EXPECT_EQ(code_points("\xC0\xAF"), U"\uFFFD\uFFFD") << "longer than needed";
  EXPECT_EQ(code_points("\xED\xA0\x80"), U"\uFFFD\uFFFD\uFFFD") << "a surrogate";
  EXPECT_EQ(code_points("\xF4\x90\x80\x80"), U"\uFFFD\uFFFD\uFFFD\uFFFD") << "beyond the last";
}

/// A micrometre that reads as a metre is a millionfold error.
TEST(Picture, WritesSignsOfUnits) {
  EXPECT_EQ(Picture::text_width("\u00B5m"), Picture::text_width("mm"));
  EXPECT_EQ(drawn("\u00B5"),
            "      \n"
            "#   # \n"
            "#   # \n"
            "#   # \n"
            "#  ## \n"
            "### # \n"
            "#     \n");
  EXPECT_EQ(drawn("\u03BCm"), drawn("\u00B5m"));
  for (const char* const sign : {"\u00C5", "\u00B0", "\u2032", "\u2033", "'", "\"", "_", "^"}) {
    EXPECT_NE(drawn(sign).find('#'), std::string::npos) << sign;
    EXPECT_NE(drawn(sign), drawn("\u65E5")) << sign;
  }
  EXPECT_EQ(drawn("\u212B"), drawn("\u00C5"));
}

TEST(Picture, DrawsABoxForWhatTheFontLacks) {
  const std::string box =
      "##### \n"
      "#   # \n"
      "#   # \n"
      "#   # \n"
      "#   # \n"
      "#   # \n"
      "##### \n";
  for (const char* const unknown : {"\u65E5", "\u03A9", "@", "\n", "\xB5"}) EXPECT_EQ(drawn(unknown), box) << unknown;
  EXPECT_EQ(drawn(" ").find('#'), std::string::npos);
}

constexpr int legend_width = 800, legend_height = 64, left = 100;

Picture legend(const std::string& unit, const std::string& meaning, double end) {
  Picture picture(left + legend_width + 100, legend_height, white);
  draw_legend(picture, left, 0, legend_width, {end, meaning}, unit);
  return picture;
}

/// Whether a text is in columns [begin, end); all texts are below the bar.
bool has_text(const Picture& picture, int begin, int end) {
  constexpr int below_bar = 30;
  for (int y = below_bar; y < picture.height(); ++y)
    for (int x = begin; x < end; ++x)
      if (picture.at(x, y) != white) return true;
  return false;
}

TEST(Legend, TextsStayApartAndWithinItsWidth) {
  constexpr int zero_end = left + 12 + 18, gap = 12;
  for (const std::string& unit :
       {std::string(), std::string("mm"), std::string("thousandths of an inch"), std::string(1000, 'w'),
        std::string(300, '\xB5'),
        std::string("\u00B5\u00B5\u00B5\u00B5\u00B5\u00B5\u00B5\u00B5") + std::string(100, 'm')}) {
    const Picture picture = legend(unit, "1e-9 of the diagonal", 1.23457e-13);
    EXPECT_FALSE(has_text(picture, 0, left + 12)) << unit;
    EXPECT_TRUE(has_text(picture, left + 12, zero_end)) << unit;
    EXPECT_FALSE(has_text(picture, zero_end, zero_end + gap)) << unit;
    EXPECT_TRUE(has_text(picture, zero_end + gap, left + legend_width)) << unit;
    EXPECT_FALSE(has_text(picture, left + legend_width, picture.width())) << unit;
  }
}

}  // namespace picture_test
}  // namespace meshbound
