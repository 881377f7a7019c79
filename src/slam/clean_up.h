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

/// The flood-fill clean-up on what is already thin, for maps put together from others: of `free` stays what
/// is connected (up, down, left, right) with one of `seeds`, and of `occupied` what touches that, corners
/// included. So goes the older drawing of a wall behind the newer one.
/// REQUIRES: both cover the same box, and no cell is in both.
void drop_unseen(CellBitmap& free, CellBitmap& occupied, std::span<const CellIndex> seeds);

}  // namespace dynslam
