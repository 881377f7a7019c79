// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "grid/cell_bitmap.h"
#include "grid/chunked_grid.h"

namespace dynslam {

/// A cell under the crest of a wall's hits.
struct Crest {
  CellIndex cell;
  float dx = 0.0F;  ///< from the cell's middle to the top of the crest, in cells, across the wall
  float dy = 0.0F;
  std::uint8_t hit = 0;
};

/// What the bytes of a local map say.
struct Sight {
  std::vector<Crest> crests;  ///< of all in `faint`, in order of chunks
  CellBitmap crest;           ///< cells of surfaces
  CellBitmap faint;           ///< crests, and what would be if there were more hits: too little to be drawn
  CellBitmap seen_through;    ///< no crest, and at least as many misses as hits
  CellBitmap thick;           ///< no crest, and more hits than misses: the slopes of walls, noise
  CellBitmap doubtful;        ///< seen through, but not clear of hits: a surface may be there all the same
};

/// Reads a map's bytes, once. The bytes of a local map nearly count hits (see kLocalMapRule), so that across
/// a wall they rise and fall like the sensor's noise and the wall is under the crest. Smoothed, a cell is a
/// crest when none of the two on either side, across the wall, has more. Along the wall nothing is compared:
/// ends, corners and posts stay. A faint crest between others, as at corners and where beams graze a wall, is
/// one too. Linear in the chunks.
Sight sight_of(const ChunkedGrid& grid);

}  // namespace dynslam
