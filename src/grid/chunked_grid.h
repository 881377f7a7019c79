// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "grid/cell_bitmap.h"
#include "grid/cell_index.h"
#include "grid/cell_rules.h"
#include "grid/chunk.h"

namespace dynslam {

/// A map as it was at one moment. Immutable, cheap to copy and to keep; any thread may read it.
class GridSnapshot {
 public:
  GridSnapshot() = default;
  GridSnapshot(ChunkTable table, ChunkBox box, double cell_size_m)
      : table_(std::make_shared<const ChunkTable>(std::move(table))), box_(box), cell_size_m_(cell_size_m) {}

  double cell_size_m() const { return cell_size_m_; }
  const ChunkBox& box() const { return box_; }
  const Chunk* find(ChunkIndex index) const { return table_ ? table_->find(index) : nullptr; }
  std::size_t chunk_count() const { return table_ ? table_->size() : 0; }
  CellState state(CellIndex c) const;

 private:
  std::shared_ptr<const ChunkTable> table_;
  ChunkBox box_;
  double cell_size_m_ = 0.02;
};

/// What a scan says of the cells around it: each cell at most once. Made by FreeSpace, applied to any grid of
/// the same frame and cell size.
struct ScanFootprint {
  CellBitmap misses;            ///< no cell of `hits` and none next to one
  std::vector<CellIndex> hits;  ///< no cell twice
};

/// The grid map of the design: two bytes a cell in chunks of 64 x 64 that exist only where something was
/// seen.
///
/// Memory: 8 KiB and about 64 bytes a chunk, and a table of at most four places (24 bytes) a chunk. Beyond
/// `max_chunks` nothing new is allotted; the looks lost by that are counted.
/// Threads: one writer. Snapshots may be handed to any thread: the first write to a chunk after a snapshot
/// goes to a fresh copy, so that no reader sees a chunk change.
class ChunkedGrid {
 public:
  explicit ChunkedGrid(double cell_size_m, std::size_t max_chunks = 32768, CellRule rule = {})
      : cell_size_m_(cell_size_m), max_chunks_(max_chunks), rule_(rule) {}

  /// A copy would share chunks that both write to.
  ChunkedGrid(const ChunkedGrid&) = delete;
  ChunkedGrid& operator=(const ChunkedGrid&) = delete;
  ChunkedGrid(ChunkedGrid&&) = default;
  ChunkedGrid& operator=(ChunkedGrid&&) = default;

  double cell_size_m() const { return cell_size_m_; }
  std::size_t max_chunks() const { return max_chunks_; }
  const ChunkBox& box() const { return box_; }
  const Chunk* find(ChunkIndex index) const { return table_.find(index); }

  std::uint8_t hit(CellIndex c) const;
  std::uint8_t miss(CellIndex c) const;
  CellState state(CellIndex c) const { return cell_state(hit(c), miss(c)); }

  void add_hit(CellIndex c);
  void add_miss(CellIndex c);
  /// Makes the cells of a chunk as sure as can be of what they are, and forgets those in neither set.
  void show(ChunkIndex index, const CellTile& free, const CellTile& occupied);
  /// All of a scan at once. Same result as add_hit and add_miss on each of its cells.
  void apply(const ScanFootprint& footprint) { apply(footprint.misses, footprint.hits); }
  void apply(const CellBitmap& misses, std::span<const CellIndex> hits);

  /// The map as it is now, without copying cells. Costs a copy of the table; chunks written later are cloned
  /// first.
  GridSnapshot snapshot();

  std::size_t chunk_count() const { return table_.size(); }
  std::size_t bytes() const {
    return chunk_count() * sizeof(Chunk) + table_.places().size() * sizeof(ChunkTable::Entry);
  }
  /// Cells that were not written because the cap on chunks was reached.
  std::uint64_t cells_refused() const { return cells_refused_; }

 private:
  Chunk* writable(ChunkIndex index);
  template <class Change>
  void change(CellIndex c, Change&& of);
  void apply_misses(const CellBitmap& misses, ChunkIndex index);

  double cell_size_m_;
  std::size_t max_chunks_;
  CellRule rule_;
  ChunkTable table_;
  ChunkBox box_;
  std::uint64_t epoch_ = 0;
  std::uint64_t cells_refused_ = 0;
};

}  // namespace dynslam
