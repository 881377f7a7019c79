// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <span>

namespace dynslam {

using Scores16 = std::array<std::uint32_t, 16>;

/// For each of 16 neighbouring x shifts: the sum over all points of the byte at `row[offset + shift]`. One
/// 16-byte load a point; sums are kept in 16 bits and emptied before they can run over.
inline Scores16 score_16_shifts(const std::uint8_t* row, std::span<const std::int32_t> offsets) {
  static_assert(std::endian::native == std::endian::little, "bytes are widened by interleaving with zeros");
  using Bytes = std::uint8_t __attribute__((vector_size(16)));
  using Words = std::uint16_t __attribute__((vector_size(16)));
  constexpr std::size_t kBeforeOverflow = 257;  // 257 * 255 = 65535
  const Bytes zero{};
  Scores16 total{};
  for (std::size_t done = 0; done < offsets.size(); done += kBeforeOverflow) {
    const std::size_t end = std::min(offsets.size(), done + kBeforeOverflow);
    Words low{}, high{};
    for (std::size_t i = done; i < end; ++i) {
      Bytes b;
      std::memcpy(&b, row + offsets[i], sizeof b);
      low += reinterpret_cast<Words>(
          __builtin_shufflevector(b, zero, 0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5, 21, 6, 22, 7, 23));
      high += reinterpret_cast<Words>(
          __builtin_shufflevector(b, zero, 8, 24, 9, 25, 10, 26, 11, 27, 12, 28, 13, 29, 14, 30, 15, 31));
    }
    for (std::size_t k = 0; k < 8; ++k) {
      total[k] += low[k];
      total[k + 8] += high[k];
    }
  }
  return total;
}

}  // namespace dynslam
