// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "base/pose2.h"
#include "grid/cell_bitmap.h"

namespace dynslam {

/// Adds the cells whose centres lie inside a polygon (even-odd), as far as the set's box goes. Outlines with
/// fewer than three corners, or with one that is not finite, hold nothing. Linear in corners times rows.
void add_inside(std::span<const Vector2> outline_m, double cell_size_m, CellBitmap& cells);

}  // namespace dynslam
