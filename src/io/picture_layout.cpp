// SPDX-License-Identifier: MIT
#include "io/picture_layout.h"

#include <algorithm>

namespace dynslam {
namespace {

constexpr int kMinMapSide = 760;  // pixels of the map's long side, margins not counted
constexpr int kMaxMapSide = 2200;

void crop_to_known(const TrinaryMap& map, PictureLayout& layout) {
  int left = map.width, right = -1, bottom = map.height, top = -1;
  for (int row = 0; row < map.height; ++row) {
    for (int column = 0; column < map.width; ++column) {
      if (map.at(column, row) == CellState::kUnknown) continue;
      left = std::min(left, column);
      right = std::max(right, column);
      bottom = std::min(bottom, row);
      top = row;
    }
  }
  if (top < 0) return;  // nothing is known: the picture shows one cell of it
  layout.left = left;
  layout.bottom = bottom;
  layout.columns = right - left + 1;
  layout.rows = top - bottom + 1;
}

/// Room for walls at the left and upper edge, which are drawn wider than they are.
void add_rim(PictureLayout& layout) {
  layout.left -= layout.shrink;
  layout.columns += layout.shrink;
  layout.rows += layout.shrink;
}

constexpr int divide_up(int a, int b) { return (a + b - 1) / b; }

}  // namespace

PictureLayout lay_out(const TrinaryMap& map) {
  PictureLayout l;
  crop_to_known(map, l);
  const int long_side = std::max(l.columns, l.rows);
  l.enlarge = std::max(1, divide_up(kMinMapSide, long_side));
  l.shrink = divide_up(l.enlarge * long_side, kMaxMapSide);
  if (l.enlarge == 1) add_rim(l);
  l.map_width = divide_up(l.columns * l.enlarge, l.shrink);
  l.map_height = divide_up(l.rows * l.enlarge, l.shrink);
  const int long_px = std::max(l.map_width, l.map_height);
  l.line_px = std::clamp(static_cast<float>(long_px) / 330.0F, 2.5F, 6.0F);
  l.text_px = std::clamp(static_cast<float>(long_px) / 52.0F, 14.0F, 34.0F);
  l.margin = long_px / 25;
  l.footer = static_cast<int>(l.text_px * 2.0F);
  // A narrow map still has room for its scale bar.
  l.width = std::max(l.map_width, long_px / 4) + 2 * l.margin;
  l.height = l.map_height + 2 * l.margin + l.footer;
  l.offset_x = (l.width - l.map_width) / 2;
  return l;
}

}  // namespace dynslam
