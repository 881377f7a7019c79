// SPDX-License-Identifier: MIT
#pragma once

#include "grid/trinary_map.h"

namespace dynslam {

/// Which cells are shown and where they lie in the picture.
struct PictureLayout {
  // The cells, as columns and rows of the map's rectangle; the rim around the known ones may lie outside of
  // it.
  int left = 0;
  int bottom = 0;
  int columns = 1;
  int rows = 1;

  // Their size: pixels a cell, or cells a pixel; one of the two is 1.
  int enlarge = 1;
  int shrink = 1;

  // In the picture, in pixels.
  int map_width = 1;
  int map_height = 1;
  int margin = 0;    ///< around the map
  int footer = 0;    ///< below that, for the scale bar
  int offset_x = 0;  ///< from the picture's left edge to the map's
  int width = 1;     ///< of the whole picture
  int height = 1;
  float line_px = 1.0F;
  float text_px = 1.0F;

  double pixels_per_cell() const { return static_cast<double>(enlarge) / shrink; }
};

/// Where everything goes in the picture of a map; a map without known cells is shown as one cell.
PictureLayout lay_out(const TrinaryMap& map);

}  // namespace dynslam
