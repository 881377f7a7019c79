// SPDX-License-Identifier: MIT
#include "plan/cell_states.h"

#include <bit>
#include <cstring>

#include "grid/cell_rules.h"

namespace dynslam {
namespace {

using Flags = std::uint8_t[kChunkSide];  ///< 0 or 1 a cell

/// Eight bytes of 0 or 1 as eight bits: the multiplication brings each to its place in the highest byte.
std::uint64_t packed(const Flags& flags) {
  constexpr std::uint64_t kGather =
      std::endian::native == std::endian::little ? 0x0102040810204080U : 0x8040201008040201U;
  std::uint64_t word = 0;
  for (int i = 0; i < 8; ++i) {
    std::uint64_t eight;
    std::memcpy(&eight, flags + 8 * i, 8);
    word |= ((eight * kGather) >> 56) << (8 * i);
  }
  return word;
}

}  // namespace

CellStates states_of(const Chunk& chunk) {
  CellStates states;
  for (std::size_t r = 0; r < kChunkSide; ++r) {
    alignas(64) Flags occupied, known;
    for (int i = 0; i < kChunkSide; ++i) {
      const CellState state = cell_state(chunk.hit[r][i], chunk.miss[r][i]);
      occupied[i] = state == CellState::kOccupied ? 1 : 0;
      known[i] = state == CellState::kUnknown ? 0 : 1;
    }
    states.occupied[r] = packed(occupied);
    states.known[r] = packed(known);
  }
  return states;
}

}  // namespace dynslam
