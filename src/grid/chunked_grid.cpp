// SPDX-License-Identifier: MIT
#include "grid/chunked_grid.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "grid/spread_bits.h"

namespace dynslam {
namespace {

using Row = std::uint8_t[kChunkSide];

void miss_whole_row(Row& hit, Row& miss, CellRule rule) {
  for (int i = 0; i < kChunkSide; ++i) {
    hit[i] = lowered(hit[i], rule.loss);
    miss[i] = raised(miss[i], rule.gain);
  }
}

void miss_row(Row& hit, Row& miss, std::uint64_t cells, CellRule rule) {
  alignas(64) Row chosen;
  for (int i = 0; i < 8; ++i) std::memcpy(chosen + 8 * i, &kSpreadBits[(cells >> (8 * i)) & 0xFF], 8);
  for (int i = 0; i < kChunkSide; ++i) {
    hit[i] = lowered(hit[i], static_cast<std::uint8_t>(chosen[i] & rule.loss));
    miss[i] = raised(miss[i], static_cast<std::uint8_t>(chosen[i] & rule.gain));
  }
}

/// Whether another miss leaves the whole row as it is: an empty room that was looked at often costs no copy.
bool is_sure_of_misses(const Row& hit, const Row& miss) {
  std::uint8_t most_hit = 0;
  std::uint8_t least_miss = 255;
  for (int i = 0; i < kChunkSide; ++i) {
    most_hit = std::max(most_hit, hit[i]);
    least_miss = std::min(least_miss, miss[i]);
  }
  return most_hit == 0 && least_miss == 255;
}

}  // namespace

CellState GridSnapshot::state(CellIndex c) const {
  const Chunk* chunk = find(chunk_of(c));
  if (!chunk) return CellState::kUnknown;
  return cell_state(chunk->hit[c.y & kChunkMask][c.x & kChunkMask],
                    chunk->miss[c.y & kChunkMask][c.x & kChunkMask]);
}

std::uint8_t ChunkedGrid::hit(CellIndex c) const {
  const Chunk* chunk = table_.find(chunk_of(c));
  return chunk ? chunk->hit[c.y & kChunkMask][c.x & kChunkMask] : std::uint8_t{0};
}

std::uint8_t ChunkedGrid::miss(CellIndex c) const {
  const Chunk* chunk = table_.find(chunk_of(c));
  return chunk ? chunk->miss[c.y & kChunkMask][c.x & kChunkMask] : std::uint8_t{0};
}

/// The chunk to write to: allotted if it is new, cloned if a snapshot may hold it; null when the cap is
/// reached.
Chunk* ChunkedGrid::writable(ChunkIndex index) {
  std::shared_ptr<Chunk>* entry = table_.find_entry(index);
  if (!entry) {
    if (table_.size() >= max_chunks_) return nullptr;
    entry = &table_.insert(index, std::make_shared<Chunk>());
    box_.include(index);
    (*entry)->version = 1;
    (*entry)->epoch = epoch_;
  } else if ((*entry)->epoch != epoch_) {
    *entry = std::make_shared<Chunk>(**entry);
    ++(*entry)->version;
    (*entry)->epoch = epoch_;
  }
  return entry->get();
}

template <class Change>
void ChunkedGrid::change(CellIndex c, Change&& of) {
  if (Chunk* chunk = writable(chunk_of(c))) {
    of(chunk->hit[c.y & kChunkMask][c.x & kChunkMask], chunk->miss[c.y & kChunkMask][c.x & kChunkMask]);
  } else {
    ++cells_refused_;
  }
}

void ChunkedGrid::add_hit(CellIndex c) {
  change(c, [this](std::uint8_t& hit, std::uint8_t& miss) {
    hit = raised(hit, rule_.gain);
    miss = lowered(miss, rule_.loss);
  });
}

void ChunkedGrid::add_miss(CellIndex c) {
  change(c, [this](std::uint8_t& hit, std::uint8_t& miss) {
    hit = lowered(hit, rule_.loss);
    miss = raised(miss, rule_.gain);
  });
}

void ChunkedGrid::show(ChunkIndex index, const CellTile& free, const CellTile& occupied) {
  Chunk* chunk = writable(index);
  for (std::size_t r = 0; r < kChunkSide; ++r) {
    if (!chunk) {
      cells_refused_ += static_cast<std::uint64_t>(std::popcount(free[r] | occupied[r]));
      continue;
    }
    for (std::size_t i = 0; i < 8; ++i) {
      std::memcpy(chunk->hit[r] + 8 * i, &kSpreadBits[(occupied[r] >> (8 * i)) & 0xFF], 8);
      std::memcpy(chunk->miss[r] + 8 * i, &kSpreadBits[(free[r] >> (8 * i)) & 0xFF], 8);
    }
  }
}

void ChunkedGrid::apply(const CellBitmap& misses, std::span<const CellIndex> hits) {
  const ChunkBox& box = misses.box();
  for (std::int32_t y = box.min.y; y <= box.max.y; ++y) {
    for (std::int32_t x = box.min.x; x <= box.max.x; ++x) apply_misses(misses, {x, y});
  }
  for (const CellIndex c : hits) add_hit(c);
}

void ChunkedGrid::apply_misses(const CellBitmap& misses, ChunkIndex index) {
  const int column = index.x - misses.box().min.x;
  const int first_row = (index.y - misses.box().min.y) * kChunkSide;
  const Chunk* old = table_.find(index);
  Chunk* chunk = nullptr;
  for (int r = 0; r < kChunkSide; ++r) {
    const std::uint64_t cells = misses.row(first_row + r)[column];
    if (cells == 0 || (!chunk && old && is_sure_of_misses(old->hit[r], old->miss[r]))) continue;
    if (!chunk) chunk = writable(index);
    if (!chunk) {
      cells_refused_ += static_cast<std::uint64_t>(std::popcount(cells));
    } else if (~cells == 0) {
      miss_whole_row(chunk->hit[r], chunk->miss[r], rule_);
    } else {
      miss_row(chunk->hit[r], chunk->miss[r], cells, rule_);
    }
  }
}

GridSnapshot ChunkedGrid::snapshot() {
  ++epoch_;
  return {table_, box_, cell_size_m_};
}

}  // namespace dynslam
