// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "grid/cell_index.h"

namespace dynslam {

inline constexpr int kChunkBits = 6;
inline constexpr int kChunkSide =
    1 << kChunkBits;  ///< cells; a row of a chunk is one 64-bit word of a CellBitmap
inline constexpr int kChunkMask = kChunkSide - 1;

/// A square of 64 x 64 cells: two planes of bytes, rows contiguous.
struct Chunk {
  alignas(64) std::uint8_t hit[kChunkSide][kChunkSide] = {};
  std::uint8_t miss[kChunkSide][kChunkSide] = {};
  std::uint64_t version = 0;  ///< grows with each epoch in which the chunk was written
  std::uint64_t epoch = 0;    ///< of the grid, when this copy was made
};

/// A set of cells of one chunk, a word a row.
using CellTile = std::array<std::uint64_t, kChunkSide>;

/// Which chunk: covers cells [64 x, 64 x + 64) by [64 y, 64 y + 64).
struct ChunkIndex {
  std::int32_t x = 0;
  std::int32_t y = 0;
  auto operator<=>(const ChunkIndex&) const = default;
};

constexpr ChunkIndex chunk_of(CellIndex c) { return {c.x >> kChunkBits, c.y >> kChunkBits}; }
constexpr CellIndex first_cell(ChunkIndex c) { return {c.x * kChunkSide, c.y * kChunkSide}; }

/// A rectangle of chunks, both ends inside; empty when max < min.
struct ChunkBox {
  ChunkIndex min{0, 0};
  ChunkIndex max{-1, -1};
  bool empty() const { return max.x < min.x || max.y < min.y; }
  int width() const { return empty() ? 0 : max.x - min.x + 1; }
  int height() const { return empty() ? 0 : max.y - min.y + 1; }
  void include(ChunkIndex c);
};

/// Finds chunks by index: a hash table with open addressing, cheap to copy as a whole. Chunks are never taken
/// out.
class ChunkTable {
 public:
  struct Entry {
    ChunkIndex index;
    std::shared_ptr<Chunk> chunk;  ///< null: an empty place
  };

  const Chunk* find(ChunkIndex index) const;
  std::shared_ptr<Chunk>* find_entry(ChunkIndex index);
  /// REQUIRES: no chunk is there yet.
  std::shared_ptr<Chunk>& insert(ChunkIndex index, std::shared_ptr<Chunk> chunk);

  std::size_t size() const { return size_; }
  /// All places, the empty ones too, in no order that means anything (but the same one every time).
  const std::vector<Entry>& places() const { return places_; }

 private:
  std::size_t place_of(ChunkIndex index) const;
  void grow();

  std::vector<Entry> places_;
  std::size_t size_ = 0;
};

}  // namespace dynslam
