// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include "grid/cell_bitmap.h"
#include "slam/finished_map.h"
#include "slam/local_map.h"

namespace dynslam {

/// What is worth keeping of a complete local map (thesis 4.1.3): surfaces about one cell thick, and the free
/// space in front of them that some robot position can be reached from. Time and memory are linear in the
/// chunks of the map.
FinishedMap clean_up(const LocalMap& map, std::uint32_t id, Time ended);

/// Takes unknown cells for occupied that fill a gap of one or two cells in a surface.
/// REQUIRES: both cover the same box.
void mend_walls(CellBitmap& occupied, const CellBitmap& free);

/// Takes unknown cells for free that lie between free ones, at most `crack_cells` apart by steps to the sides
/// that lead through no surface: neither the inside of a thin wall nor what lies behind one is a crack.
/// REQUIRES: both cover the same box.
void fill_cracks(CellBitmap& free, const CellBitmap& occupied, int crack_cells);

/// The flood-fill clean-up on a map put together from others, where an older drawing of a wall may lie behind
/// the newer one with a gap between them: free space that is nowhere wider than `gap_cells` and has no way to
/// wider parts goes, and so do the surfaces no more than half of that behind one that free space, or an
/// unknown cell beside it, touches. What was seen from afar and has no way to it, as a room behind a door
/// that is shut now, is wider and stays; so does a wall behind what stands before it. REQUIRES: both cover
/// the same box, and no cell is in both.
void drop_gaps(CellBitmap& free, CellBitmap& occupied, int gap_cells);

}  // namespace dynslam
