// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "grid/cell_bitmap.h"
#include "grid/tiled_bitmap.h"

namespace dynslam {

/// What counts as a post, in cells along either axis.
struct PostSize {
  int thick = 5;   ///< it reaches no farther than this
  int alone = 15;  ///< and up to this there is nothing else
};

/// Of PostSize's: a row of the surroundings is one word.
constexpr int kMostAlone = 31;

/// The cells inside of `within` that belong to a thin thing that stands alone. A lidar sees no more of an
/// office chair, a stool or a fan than its post; its foot spreads below. Linear in the occupied cells.
/// REQUIRES: size.thick <= size.alone <= kMostAlone.
std::vector<CellIndex> lone_posts(const CellBitmap& occupied, const CellBox& within, const PostSize& size);

}  // namespace dynslam
