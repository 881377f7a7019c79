// SPDX-License-Identifier: MIT
#include "grid/bitmap_sets.h"

#include <algorithm>

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

constexpr int kAlong = 2, kAcross = 2;  ///< cells, of grown_across

/// A word of a row and what is to its left and right.
struct WordAndSides {
  std::uint64_t left = 0, here = 0, right = 0;
  /// The word with the row moved by n cells to the right, n not 0.
  std::uint64_t moved(int n) const {
    return n > 0 ? here << n | left >> (64 - n) : here >> -n | right << (64 + n);
  }
};

WordAndSides around(const CellBitmap& cells, int row, int word) {
  if (row < 0 || row >= cells.rows()) return {};
  const std::uint64_t* at = cells.row(row) + word;
  return {word > 0 ? at[-1] : 0, at[0], word + 1 < cells.words_per_row() ? at[1] : 0};
}

WordAndSides either(const WordAndSides& a, const WordAndSides& b) {
  return {a.left | b.left, a.here | b.here, a.right | b.right};
}

CellBitmap widened(const CellBitmap& cells) {
  CellBitmap out;
  out.reset(cells.box());
  for (int r = 0; r < out.rows(); ++r) widen_row(cells.row(r), out.row(r), out.words_per_row());
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

CellBitmap complement(const CellBitmap& cells) {
  CellBitmap out;
  out.reset(cells.box());
  change_words(out, cells, [](std::uint64_t& a, std::uint64_t b) { a = ~b; });
  return out;
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

CellBitmap grown_across(const CellBitmap& cells) {
  const int rows = cells.rows(), words = cells.words_per_row();
  CellBitmap out = cells;
  for (int r = 0; r < rows; ++r) {
    for (int w = 0; w < words; ++w) {
      const std::uint64_t here = cells.row(r)[w];
      if (here == 0) continue;
      const WordAndSides low = around(cells, r - kAlong, w), high = around(cells, r + kAlong, w);
      WordAndSides column = either(low, high);
      for (int y = r - kAlong + 1; y < r + kAlong; ++y) column = either(column, around(cells, y, w));
      std::uint64_t below = low.here, above = high.here;
      for (int n = 1; n <= kAlong; ++n) {
        below |= low.moved(n) | low.moved(-n);
        above |= high.moved(n) | high.moved(-n);
      }
      const std::uint64_t left = column.moved(kAlong), right = column.moved(-kAlong);
      const std::uint64_t post = ~(left | right | below | above);
      const std::uint64_t up_down = here & ((left & right) | post),
                          sideways = here & ((below & above) | post);
      for (int y = std::max(r - kAcross, 0); y <= std::min(r + kAcross, rows - 1); ++y)
        out.row(y)[w] |= up_down;
      for (int n = 1; n <= kAcross; ++n) {
        out.row(r)[w] |= sideways << n | sideways >> n;
        if (w > 0) out.row(r)[w - 1] |= sideways << (64 - n);
        if (w + 1 < words) out.row(r)[w + 1] |= sideways >> (64 - n);
      }
    }
  }
  return out;
}

CellBitmap gaps_in_lines(const CellBitmap& cells) {
  CellBitmap out;
  out.reset(cells.box());
  for (int r = 0; r < cells.rows(); ++r) {
    for (int w = 0; w < cells.words_per_row(); ++w) {
      const WordAndSides row = around(cells, r, w), up = around(cells, r + 1, w),
                         down = around(cells, r - 1, w);
      if ((row.left | row.here | row.right | up.here | down.here) == 0) continue;
      const WordAndSides up2 = around(cells, r + 2, w), down2 = around(cells, r - 2, w);
      const WordAndSides beside = either(up, down), all = either(beside, row);
      const auto either_side = [](const WordAndSides& of) { return of.moved(1) | of.moved(-1); };
      const std::uint64_t end_left = row.moved(1) & ~beside.moved(1),
                          end_right = row.moved(-1) & ~beside.moved(-1);
      const std::uint64_t end_up = up.here & ~either_side(up), end_down = down.here & ~either_side(down);
      const std::uint64_t gap_x =
          (end_left & (all.moved(-1) | all.moved(-2))) | (end_right & (all.moved(1) | all.moved(2)));
      const WordAndSides above = either(up, up2), below = either(down, down2);
      const std::uint64_t gap_y =
          (end_down & (above.here | either_side(above))) | (end_up & (below.here | either_side(below)));
      out.row(r)[w] = ~row.here & ((gap_x & ~beside.here) | (gap_y & ~either_side(row)));
    }
  }
  return out;
}

CellBitmap shrunk_all_round(const CellBitmap& cells, int times) {
  return complement(grown_all_round(complement(cells), times));
}

}  // namespace dynslam
