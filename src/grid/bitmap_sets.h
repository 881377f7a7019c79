// SPDX-License-Identifier: MIT
#pragma once

#include "grid/cell_bitmap.h"

/// Sets of cells taken together, a word at a time. Where two are given, they cover the same box.
namespace dynslam {

void add_all(CellBitmap& cells, const CellBitmap& others);
void keep_only(CellBitmap& cells, const CellBitmap& others);
void take_out(CellBitmap& cells, const CellBitmap& others);

/// The cells and the four beside each, as far as the box goes.
CellBitmap grown_by_sides(const CellBitmap& cells);
/// The cells and the eight around each, `times` over.
CellBitmap grown_all_round(const CellBitmap& cells, int times = 1);

/// The cells whose eight neighbours are in the set too, `times` over; beyond the box there is nothing to
/// miss.
CellBitmap shrunk_all_round(const CellBitmap& cells, int times = 1);

}  // namespace dynslam
