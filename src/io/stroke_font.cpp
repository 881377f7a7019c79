// SPDX-License-Identifier: MIT
#include "io/stroke_font.h"

namespace dynslam {
namespace {

constexpr float kGridHeight = 6.0F;  // glyphs are drawn on points 0 to 4 across, 0 to 6 down
constexpr float kGap = 1.8F;
constexpr float kLineShare = 0.15F;  // of the height

struct Glyph {
  char letter;
  float width;
  std::string_view lines;  ///< points "xy"; ' ' goes on with the line, '|' begins another
};

constexpr Glyph kGlyphs[] = {
    {'0', 4, "10 30 41 45 36 16 05 01 10"},
    {'1', 2, "01 20 26"},
    {'2', 4, "01 10 30 41 42 06 46"},
    {'3', 4, "01 10 30 41 42 33 23|33 44 45 36 16 05"},
    {'4', 4, "36 30 04 44"},
    {'5', 4, "40 00 03 12 32 43 45 36 16 05"},
    {'6', 4, "41 30 10 01 05 16 36 45 44 33 13 04"},
    {'7', 4, "00 40 16"},
    {'8', 4, "13 02 01 10 30 41 42 33 13 04 05 16 36 45 44 33"},
    {'9', 4, "42 33 13 02 01 10 30 41 45 36 16 05"},
    {'.', 0, "06"},
    {'k', 3, "00 06|32 04|13 36"},
    {'m', 4, "06 02|03 12 23 26|23 32 43 46"},
};
constexpr Glyph kSpace{' ', 1, ""};

const Glyph& glyph_of(char letter) {
  for (const Glyph& glyph : kGlyphs) {
    if (glyph.letter == letter) return glyph;
  }
  return kSpace;
}

void append_glyph(std::vector<Stroke>& strokes, const Glyph& glyph, float x, float y, float unit_px,
                  Rgb colour) {
  for (std::size_t i = 0; i + 1 < glyph.lines.size(); i += 3) {
    if (i == 0 || glyph.lines[i - 1] == '|')
      strokes.push_back({{}, kGridHeight * unit_px * kLineShare, 0.0F});
    const auto column = static_cast<float>(glyph.lines[i] - '0');
    const auto row = static_cast<float>(glyph.lines[i + 1] - '0');
    strokes.back().points.push_back({x + column * unit_px, y + row * unit_px, colour});
  }
}

}  // namespace

float text_width(std::string_view text, float height_px) {
  float units = text.empty() ? 0.0F : -kGap;
  for (const char letter : text) units += glyph_of(letter).width + kGap;
  return units * height_px / kGridHeight;
}

std::vector<Stroke> text_strokes(std::string_view text, float x, float y, float height_px, Rgb colour) {
  std::vector<Stroke> strokes;
  const float unit_px = height_px / kGridHeight;
  for (const char letter : text) {
    const Glyph& glyph = glyph_of(letter);
    append_glyph(strokes, glyph, x, y, unit_px, colour);
    x += (glyph.width + kGap) * unit_px;
  }
  return strokes;
}

}  // namespace dynslam
