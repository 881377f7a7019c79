// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

#include "base/pose2.h"
#include "slam/finished_map.h"

namespace dynslam {

/// A square block of the global map, at most 32 cells wide; a word of bits a row.
struct BlockView {
  static constexpr int kMost = 32;
  using Rows = std::array<std::uint32_t, kMost>;

  CellIndex first;
  int side = kMost;
  Rows undecided{};  ///< cells of which no map so far said anything
  Rows no_wall{};    ///< an older surface here would be a newer one's shadow
  Rows free{};
  Rows occupied{};

  BlockView(CellIndex first_cell, int side_cells);
  bool is_decided() const;
};

/// What a map added to a block.
struct Testimony {
  int free = 0;
  int occupied = 0;
};

/// Lets a map say what it knows of the undecided cells of a block. The map is turned by its pose: a cell is
/// occupied when a surface passes within a quarter of it (a line one cell thick falls between the centres of
/// a turned grid), otherwise free when its middle is.
Testimony hear(const FinishedMap& map, const Pose2& map_T_origin, BlockView& block);

}  // namespace dynslam
