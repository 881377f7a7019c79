// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "grid/cell_bitmap.h"
#include "grid/chunked_grid.h"

namespace dynslam {

/// The cells of a chunk, or of a whole map, that are in the given state. Linear in the map's chunks.
CellTile cells_in_state(const Chunk& chunk, CellState state);
CellBitmap cells_in_state(const GridSnapshot& map, CellState state);

/// The cells of `through` that can be reached from `seeds` by steps up, down, left and right inside
/// `through`. Seeds that are not in `through` are passed over. Linear in the cells reached, a span of a row
/// at a time.
CellBitmap flood_fill(const CellBitmap& through, std::span<const CellIndex> seeds);
/// The same; `seeds` covers the same box.
CellBitmap flood_fill(const CellBitmap& through, const CellBitmap& seeds);

}  // namespace dynslam
