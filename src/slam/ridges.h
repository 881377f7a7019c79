// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "grid/chunked_grid.h"

namespace dynslam {

/// A cell under the crest of a wall's hits.
struct Crest {
  CellIndex cell;
  float dx = 0.0F;  ///< from the cell's middle to the top of the crest, in cells, across the wall
  float dy = 0.0F;
  std::uint8_t hit = 0;
};

/// The crests of the hit plane, one cell wide. The bytes of a local map nearly count hits (see kLocalMapRule),
/// so that across a wall they rise and fall like the sensor's noise and the wall is under the crest. Smoothed,
/// a cell stays when none of the two on either side, across the wall, has more. Along the wall nothing is
/// compared: ends, corners and posts stay.
std::vector<Crest> find_crests(const ChunkedGrid& grid);

}  // namespace dynslam
