// SPDX-License-Identifier: MIT
#include "server/map_message.h"

#include <stdexcept>

#include <zlib.h>

#include "grid/cell_rules.h"
#include "server/wire_bytes.h"

namespace dynslam {
namespace {

constexpr std::uint8_t kMapKind = 2;
constexpr std::uint8_t kHaveKind = 1;
constexpr std::size_t kHaveHead = 16, kHaveEntry = 8;
constexpr int kFastDeflate = 1;

std::uint8_t code_cell(std::uint8_t hit, std::uint8_t miss) {
  switch (cell_state(hit, miss)) {
    case CellState::kOccupied:
      return static_cast<std::uint8_t>(2U << 6 | static_cast<unsigned>(hit) >> 5);
    case CellState::kFree:
      return static_cast<std::uint8_t>(1U << 6 | static_cast<unsigned>(miss) >> 5);
    case CellState::kUnknown:
      break;
  }
  return 0;
}

std::string deflated(const std::string& raw) {
  uLongf size = compressBound(raw.size());
  std::string packed(size, '\0');
  const int failed = compress2(reinterpret_cast<Bytef*>(packed.data()), &size,
                               reinterpret_cast<const Bytef*>(raw.data()), raw.size(), kFastDeflate);
  if (failed != Z_OK) throw std::runtime_error("zlib cannot pack a part of the map");
  packed.resize(size);
  return packed;
}

}  // namespace

CodedCells code_cells(const Chunk& chunk) {
  CodedCells cells;
  const std::uint8_t* hit = &chunk.hit[0][0];
  const std::uint8_t* miss = &chunk.miss[0][0];
  for (std::size_t i = 0; i < cells.size(); ++i) cells[i] = code_cell(hit[i], miss[i]);
  return cells;
}

std::string to_bytes(const MapMessage& message, std::span<const CodedChunk> chunks) {
  std::string raw;
  raw.reserve(chunks.size() * (sizeof(CodedCells) + 16));
  for (const CodedChunk& chunk : chunks) {
    append_le(raw, static_cast<std::int16_t>(chunk.index.x));
    append_le(raw, static_cast<std::int16_t>(chunk.index.y));
    append_le(raw, chunk.version);
    append_le(raw, seconds_of(chunk.changed));
    raw.append(reinterpret_cast<const char*>(chunk.cells.data()), chunk.cells.size());
  }
  std::string bytes;
  append_le(bytes, kMapKind);
  append_le(bytes, static_cast<std::uint8_t>(message.all_sent ? 1 : 0));
  append_le(bytes, static_cast<std::uint16_t>(chunks.size()));
  append_le(bytes, message.cell_size_m);
  append_le(bytes, message.map_id);
  append_le(bytes, seconds_of(message.sent));
  return bytes + deflated(raw);
}

std::optional<MapHave> parse_map_have(std::string_view bytes) {
  if (bytes.size() < kHaveHead || bytes.size() > kLongestMapHave) return std::nullopt;
  const auto count = read_le<std::uint32_t>(bytes, 4);
  if (read_le<std::uint32_t>(bytes, 0) != kHaveKind) return std::nullopt;
  if (bytes.size() - kHaveHead != kHaveEntry * static_cast<std::size_t>(count)) return std::nullopt;
  MapHave have{read_le<std::uint64_t>(bytes, 8), {}};
  for (std::size_t at = kHaveHead; at < bytes.size(); at += kHaveEntry)
    have.chunks[{read_le<std::int16_t>(bytes, at), read_le<std::int16_t>(bytes, at + 2)}] =
        read_le<std::uint32_t>(bytes, at + 4);
  return have;
}

}  // namespace dynslam
