// SPDX-License-Identifier: MIT
#include "grid/chunk.h"

#include <algorithm>
#include <utility>

namespace dynslam {

void ChunkBox::include(ChunkIndex c) {
  if (empty()) {
    min = max = c;
    return;
  }
  min = {std::min(min.x, c.x), std::min(min.y, c.y)};
  max = {std::max(max.x, c.x), std::max(max.y, c.y)};
}

/// Where `index` is, or the empty place where it would go. REQUIRES: there is an empty place.
std::size_t ChunkTable::place_of(ChunkIndex index) const {
  const auto key =
      (std::uint64_t{static_cast<std::uint32_t>(index.x)} << 32) | static_cast<std::uint32_t>(index.y);
  std::uint64_t hash = key * 0x9E3779B97F4A7C15ULL;
  hash ^= hash >> 32;
  const std::size_t mask = places_.size() - 1;
  std::size_t place = static_cast<std::size_t>(hash) & mask;
  while (places_[place].chunk && places_[place].index != index) place = (place + 1) & mask;
  return place;
}

const Chunk* ChunkTable::find(ChunkIndex index) const {
  return places_.empty() ? nullptr : places_[place_of(index)].chunk.get();
}

std::shared_ptr<Chunk>* ChunkTable::find_entry(ChunkIndex index) {
  if (places_.empty()) return nullptr;
  Entry& entry = places_[place_of(index)];
  return entry.chunk ? &entry.chunk : nullptr;
}

std::shared_ptr<Chunk>& ChunkTable::insert(ChunkIndex index, std::shared_ptr<Chunk> chunk) {
  if (2 * (size_ + 1) > places_.size()) grow();
  Entry& entry = places_[place_of(index)];
  entry = {index, std::move(chunk)};
  ++size_;
  return entry.chunk;
}

void ChunkTable::grow() {
  std::vector<Entry> old(std::max<std::size_t>(64, 2 * places_.size()));
  old.swap(places_);
  for (Entry& e : old) {
    if (e.chunk) places_[place_of(e.index)] = std::move(e);
  }
}

}  // namespace dynslam
