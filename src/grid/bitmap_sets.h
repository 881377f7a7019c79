// SPDX-License-Identifier: MIT
#pragma once

#include "grid/cell_bitmap.h"

/// Sets of cells taken together, a word at a time. Where two are given, they cover the same box.
namespace dynslam {

void add_all(CellBitmap& cells, const CellBitmap& others);
void keep_only(CellBitmap& cells, const CellBitmap& others);
void take_out(CellBitmap& cells, const CellBitmap& others);

/// The cells of the box that are not in the set.
CellBitmap complement(const CellBitmap& cells);
/// The cells and the four beside each, as far as the box goes.
CellBitmap grown_by_sides(const CellBitmap& cells);
/// The cells and the eight around each, `times` over.
CellBitmap grown_all_round(const CellBitmap& cells, int times = 1);
/// The cells and the two on either side of the lines that they form: over and under where a line goes on to
/// the left and the right, left and right where it goes on above and below, all four sides of a post, around
/// which nothing goes on two cells away. The ends of lines, and what lies past them, get nothing.
CellBitmap grown_across(const CellBitmap& cells);

/// What is missing of lines one cell thick: gaps of one or two cells between an end and where the line goes
/// on, straight ahead or a cell to the side.
CellBitmap gaps_in_lines(const CellBitmap& cells);

/// The cells whose eight neighbours are in the set too, `times` over; beyond the box there is nothing to
/// miss.
CellBitmap shrunk_all_round(const CellBitmap& cells, int times = 1);

}  // namespace dynslam
