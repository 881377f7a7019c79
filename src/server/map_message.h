// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "base/time.h"
#include "grid/chunk.h"

namespace dynslam {

/// The cells of a chunk as the page gets them, a byte each, row by row from the lowest y (web/wire.md): bits
/// 6 and 7 the state (0 unknown, 1 free, 2 occupied), bits 0 to 2 how sure that is (0 to 7).
using CodedCells = std::array<std::uint8_t, static_cast<std::size_t>(kChunkSide) * kChunkSide>;
CodedCells code_cells(const Chunk& chunk);

/// One chunk on its way to a client.
struct CodedChunk {
  ChunkIndex index;
  std::uint32_t version = 0;  ///< counted up whenever the coded cells changed
  Time changed;               ///< when they did
  CodedCells cells{};
};

/// A message of the socket `map`: chunks packed with zlib.
struct MapMessage {
  std::uint64_t map_id = 0;
  Time sent;
  float cell_size_m = 0.0F;
  bool all_sent = false;  ///< nothing newer is left once these are there
};
/// REQUIRES: at most 65535 chunks, each is_sendable().
std::string to_bytes(const MapMessage& message, std::span<const CodedChunk> chunks);
/// Whether the wire has room for its index.
constexpr bool is_sendable(ChunkIndex c) {
  return c.x >= -32768 && c.x <= 32767 && c.y >= -32768 && c.y <= 32767;
}

/// What a client has of a map, told by it after it connected.
using ChunkVersions = std::map<ChunkIndex, std::uint32_t>;
struct MapHave {
  std::uint64_t map_id = 0;  ///< 0: nothing of any map
  ChunkVersions chunks;
};
inline constexpr std::size_t kLongestMapHave = 16 + 8 * 32768;

/// Nothing when the bytes make no sense. Of a chunk named twice the last counts.
std::optional<MapHave> parse_map_have(std::string_view bytes);

}  // namespace dynslam
