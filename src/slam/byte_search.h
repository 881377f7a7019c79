// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <span>

namespace dynslam {

using Scores16 = std::array<std::uint32_t, 16>;

/// For each of 16 neighbouring x shifts: the sum over all points of the byte at `row[offset + shift]`. One 16-byte
/// load a point; sums are kept in 16 bits and emptied before they can run over.
inline Scores16 score_16_shifts(const std::uint8_t* row, std::span<const std::int32_t> offsets) {
  using Bytes = std::uint8_t __attribute__((vector_size(16)));
  using Words = std::uint16_t __attribute__((vector_size(32)));
  constexpr std::size_t kBeforeOverflow = 257;  // 257 * 255 = 65535
  Scores16 total{};
  for (std::size_t done = 0; done < offsets.size(); done += kBeforeOverflow) {
    const std::size_t end = std::min(offsets.size(), done + kBeforeOverflow);
    Words sum{};
    for (std::size_t i = done; i < end; ++i) {
      Bytes bytes;
      std::memcpy(&bytes, row + offsets[i], sizeof bytes);
      sum += __builtin_convertvector(bytes, Words);
    }
    for (std::size_t k = 0; k < 16; ++k) total[k] += sum[k];
  }
  return total;
}

}  // namespace dynslam
