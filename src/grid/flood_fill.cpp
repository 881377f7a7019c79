// SPDX-License-Identifier: MIT
#include "grid/flood_fill.h"

#include <bit>
#include <cstddef>
#include <cstring>
#include <vector>

namespace dynslam {
namespace {

/// The lowest bits of eight bytes, the first one's lowest: the product moves them all into its top byte.
std::uint8_t low_bits(const std::uint8_t* bytes) {
  std::uint64_t eight = 0;
  if constexpr (std::endian::native == std::endian::little) {
    std::memcpy(&eight, bytes, 8);
  } else {
    for (unsigned b = 0; b < 8; ++b) eight |= std::uint64_t{bytes[b]} << (8 * b);
  }
  return static_cast<std::uint8_t>(eight * 0x0102040810204080ULL >> 56);
}

std::uint64_t word_in_state(const Chunk& chunk, int row, CellState state) {
  std::uint8_t is_so[kChunkSide];
  for (int i = 0; i < kChunkSide; ++i) {
    is_so[i] = cell_state(chunk.hit[row][i], chunk.miss[row][i]) == state ? 1 : 0;
  }
  std::uint64_t word = 0;
  for (int i = 0; i < kChunkSide; i += 8) word |= std::uint64_t{low_bits(is_so + i)} << i;
  return word;
}

/// The fill of one call. A step takes a word's newly reached bits and offers them to the four words around
/// it.
class Filler {
 public:
  Filler(const CellBitmap& through, CellBitmap& reached) : through_(through), reached_(reached) {}

  /// Adds what of `cells` is free to pass and new, spread along the word as far as `through` goes.
  void offer(int row, int word, std::uint64_t cells) {
    if (row < 0 || row >= through_.rows() || word < 0 || word >= through_.words_per_row()) return;
    const std::uint64_t open = through_.row(row)[word];
    std::uint64_t& reached = reached_.row(row)[word];
    std::uint64_t fresh = cells & open & ~reached;
    if (fresh == 0) return;
    for (std::uint64_t before = 0; before != fresh;) {
      before = fresh;
      fresh |= ((fresh << 1) | (fresh >> 1)) & open;
    }
    fresh &= ~reached;
    reached |= fresh;
    pending_.push_back({row, word, fresh});
  }

  void run() {
    while (!pending_.empty()) {
      const Step s = pending_.back();
      pending_.pop_back();
      offer(s.row + 1, s.word, s.cells);
      offer(s.row - 1, s.word, s.cells);
      offer(s.row, s.word + 1, s.cells >> 63);
      offer(s.row, s.word - 1, s.cells << 63);
    }
  }

 private:
  struct Step {
    int row, word;
    std::uint64_t cells;
  };
  const CellBitmap& through_;
  CellBitmap& reached_;
  std::vector<Step> pending_;
};

}  // namespace

CellTile cells_in_state(const Chunk& chunk, CellState state) {
  CellTile cells;
  for (int r = 0; r < kChunkSide; ++r) cells[static_cast<std::size_t>(r)] = word_in_state(chunk, r, state);
  return cells;
}

CellBitmap cells_in_state(const GridSnapshot& map, CellState state) {
  CellBitmap cells;
  cells.reset(map.box());
  for (std::int32_t y = map.box().min.y; y <= map.box().max.y; ++y) {
    for (std::int32_t x = map.box().min.x; x <= map.box().max.x; ++x) {
      const Chunk* chunk = map.find({x, y});
      if (chunk) cells.put({x, y}, cells_in_state(*chunk, state));
    }
  }
  return cells;
}

CellBitmap flood_fill(const CellBitmap& through, std::span<const CellIndex> seeds) {
  CellBitmap reached;
  reached.reset(through.box());
  Filler filler(through, reached);
  for (const CellIndex seed : seeds) {
    if (!through.test(seed)) continue;
    filler.offer(seed.y - through.first().y, (seed.x >> kChunkBits) - through.box().min.x,
                 std::uint64_t{1} << (seed.x & kChunkMask));
  }
  filler.run();
  return reached;
}

CellBitmap flood_fill(const CellBitmap& through, const CellBitmap& seeds) {
  CellBitmap reached;
  reached.reset(through.box());
  Filler filler(through, reached);
  for (int row = 0; row < seeds.rows(); ++row) {
    for (int word = 0; word < seeds.words_per_row(); ++word) filler.offer(row, word, seeds.row(row)[word]);
  }
  filler.run();
  return reached;
}

}  // namespace dynslam
