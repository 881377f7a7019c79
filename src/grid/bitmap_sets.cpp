// SPDX-License-Identifier: MIT
#include "grid/bitmap_sets.h"

namespace dynslam {
namespace {

template <class Change>
void change_words(CellBitmap& cells, const CellBitmap& others, Change&& change) {
  for (int r = 0; r < cells.rows(); ++r) {
    for (int w = 0; w < cells.words_per_row(); ++w) change(cells.row(r)[w], others.row(r)[w]);
  }
}

/// A row's cells and those to their left and right.
void widen_row(const std::uint64_t* from, std::uint64_t* to, int words) {
  for (int w = 0; w < words; ++w) {
    const std::uint64_t from_left = w > 0 ? from[w - 1] >> 63 : 0;
    const std::uint64_t from_right = w + 1 < words ? from[w + 1] << 63 : 0;
    to[w] = from[w] | (from[w] << 1) | (from[w] >> 1) | from_left | from_right;
  }
}

void add_row(const CellBitmap& cells, int row, std::uint64_t* to) {
  if (row < 0 || row >= cells.rows()) return;
  for (int w = 0; w < cells.words_per_row(); ++w) to[w] |= cells.row(row)[w];
}

/// Each row widened, and the rows above and below added as they are in `beside`.
CellBitmap grown(const CellBitmap& widened, const CellBitmap& beside) {
  CellBitmap out = widened;
  for (int r = 0; r < out.rows(); ++r) {
    add_row(beside, r - 1, out.row(r));
    add_row(beside, r + 1, out.row(r));
  }
  return out;
}

CellBitmap widened(const CellBitmap& cells) {
  CellBitmap out;
  out.reset(cells.box());
  for (int r = 0; r < out.rows(); ++r) widen_row(cells.row(r), out.row(r), out.words_per_row());
  return out;
}

CellBitmap complement(const CellBitmap& cells) {
  CellBitmap out;
  out.reset(cells.box());
  change_words(out, cells, [](std::uint64_t& a, std::uint64_t b) { a = ~b; });
  return out;
}

}  // namespace

void add_all(CellBitmap& cells, const CellBitmap& others) {
  change_words(cells, others, [](std::uint64_t& a, std::uint64_t b) { a |= b; });
}

void keep_only(CellBitmap& cells, const CellBitmap& others) {
  change_words(cells, others, [](std::uint64_t& a, std::uint64_t b) { a &= b; });
}

void take_out(CellBitmap& cells, const CellBitmap& others) {
  change_words(cells, others, [](std::uint64_t& a, std::uint64_t b) { a &= ~b; });
}

CellBitmap grown_by_sides(const CellBitmap& cells) { return grown(widened(cells), cells); }

CellBitmap grown_all_round(const CellBitmap& cells, int times) {
  CellBitmap out = cells;
  for (int i = 0; i < times; ++i) {
    const CellBitmap wide = widened(out);
    out = grown(wide, wide);
  }
  return out;
}

CellBitmap shrunk_all_round(const CellBitmap& cells, int times) {
  return complement(grown_all_round(complement(cells), times));
}

}  // namespace dynslam
