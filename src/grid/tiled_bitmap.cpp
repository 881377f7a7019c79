// SPDX-License-Identifier: MIT
#include "grid/tiled_bitmap.h"

#include <algorithm>
#include <bit>
#include <limits>

namespace dynslam {
namespace {

constexpr std::uint64_t kFull = ~std::uint64_t{0};

constexpr CellTile filled(std::uint64_t word) {
  CellTile tile{};
  for (std::uint64_t& w : tile) w = word;
  return tile;
}
constexpr CellTile kClearTile = filled(0);
constexpr CellTile kFullTile = filled(kFull);

ChunkBox box_of_what_is_set(const CellBitmap& cells) {
  ChunkBox box;
  for (int r = 0; r < cells.rows(); ++r) {
    for (int w = 0; w < cells.words_per_row(); ++w) {
      if (cells.row(r)[w] != 0) box.include({cells.box().min.x + w, cells.box().min.y + r / kChunkSide});
    }
  }
  return box;
}

}  // namespace

TiledBitmap::TiledBitmap(const CellBitmap& cells) : box_(box_of_what_is_set(cells)) {
  places_.reserve(static_cast<std::size_t>(box_.width()) * static_cast<std::size_t>(box_.height()));
  for (std::int32_t y = box_.min.y; y <= box_.max.y; ++y) {
    for (std::int32_t x = box_.min.x; x <= box_.max.x; ++x) add(cells.tile({x, y}));
  }
  tiles_.shrink_to_fit();
}

void TiledBitmap::add(const CellTile& tile) {
  std::uint64_t any = 0, all = kFull;
  for (const std::uint64_t w : tile) any |= w, all &= w;
  if (any == 0 || all == kFull) {
    places_.push_back(any == 0 ? kNone : kAll);
    return;
  }
  places_.push_back(kFirst + static_cast<Place>(tiles_.size()));
  tiles_.push_back(tile);
}

const CellTile& TiledBitmap::tile(ChunkIndex chunk) const {
  if (chunk.x < box_.min.x || chunk.x > box_.max.x || chunk.y < box_.min.y || chunk.y > box_.max.y)
    return kClearTile;
  const Place place =
      places_[static_cast<std::size_t>(chunk.y - box_.min.y) * static_cast<std::size_t>(box_.width()) +
              static_cast<std::size_t>(chunk.x - box_.min.x)];
  return place == kNone ? kClearTile : place == kAll ? kFullTile : tiles_[place - kFirst];
}

std::uint64_t TiledBitmap::word(CellIndex first) const {
  const ChunkIndex chunk = chunk_of(first);
  const int shift = first.x & kChunkMask;
  const std::uint64_t left = tile(chunk)[row_of(first)] >> shift;
  return shift == 0 ? left : left | tile({chunk.x + 1, chunk.y})[row_of(first)] << (kChunkSide - shift);
}

void TiledBitmap::words(CellIndex first, std::span<std::uint64_t> rows) const {
  const int shift = first.x & kChunkMask;
  for (std::size_t done = 0; done < rows.size();) {
    const CellIndex at{first.x, first.y + static_cast<std::int32_t>(done)};
    const CellTile& left = tile(chunk_of(at));
    const CellTile& right = tile({chunk_of(at).x + 1, chunk_of(at).y});
    const std::size_t low = row_of(at), n = std::min(rows.size() - done, kChunkSide - low);
    for (std::size_t r = 0; r < n; ++r) {
      const std::uint64_t beyond = shift == 0 ? 0 : right[low + r] << (kChunkSide - shift);
      rows[done + r] = left[low + r] >> shift | beyond;
    }
    done += n;
  }
}

CellBox TiledBitmap::bounds() const {
  constexpr auto kMost = std::numeric_limits<std::int32_t>::max();
  CellBox bounds{{kMost, kMost}, {-kMost, -kMost}};
  for (std::int32_t y = box_.min.y; y <= box_.max.y; ++y) {
    for (std::int32_t x = box_.min.x; x <= box_.max.x; ++x) {
      const CellTile& cells = tile({x, y});
      const CellIndex first = first_cell({x, y});
      for (int r = 0; r < kChunkSide; ++r) {
        const std::uint64_t row = cells[static_cast<std::size_t>(r)];
        if (row == 0) continue;
        bounds.min = {std::min(bounds.min.x, first.x + std::countr_zero(row)),
                      std::min(bounds.min.y, first.y + r)};
        bounds.max = {std::max(bounds.max.x, first.x + kChunkSide - 1 - std::countl_zero(row)),
                      std::max(bounds.max.y, first.y + r)};
      }
    }
  }
  return empty() ? CellBox{} : bounds;
}

std::size_t TiledBitmap::count() const {
  std::size_t n = 0;
  for (std::int32_t y = box_.min.y; y <= box_.max.y; ++y) {
    for (std::int32_t x = box_.min.x; x <= box_.max.x; ++x) {
      for (const std::uint64_t row : tile({x, y})) n += static_cast<std::size_t>(std::popcount(row));
    }
  }
  return n;
}

}  // namespace dynslam
