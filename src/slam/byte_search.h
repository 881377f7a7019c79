// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace dynslam {

using Scores16 = std::array<std::uint32_t, 16>;

/// For each of 16 neighbouring x shifts and `Rows` neighbouring y shifts: the sum over all points of the
/// byte at `row[offset + y stride + x]`. One 16-byte load a point and row; where a point lies is looked up
/// once for all rows.
template <std::size_t Rows>
std::array<Scores16, Rows> score_rows(const std::uint8_t* row, std::ptrdiff_t stride,
                                      std::span<const std::int32_t> offsets) {
  static_assert(std::endian::native == std::endian::little, "even bytes are the low halves of words");
  using Words = std::uint16_t __attribute__((vector_size(16)));
  constexpr std::size_t kBeforeOverflow = 257;  // 257 * 255 = 65535
  std::array<Scores16, Rows> total{};
  for (std::size_t done = 0; done < offsets.size(); done += kBeforeOverflow) {
    const std::size_t end = std::min(offsets.size(), done + kBeforeOverflow);
    // Sums in 16 bits: of the odd bytes, and of whole words, which run over. What is left of them without the
    // odd bytes' share is the sum of the even ones, which does not.
    Words odd[Rows]{}, whole[Rows]{};
    for (std::size_t i = done; i < end; ++i) {
      const std::uint8_t* at = row + offsets[i];
      for (std::size_t r = 0; r < Rows; ++r, at += stride) {
        Words w;
        std::memcpy(&w, at, sizeof w);
        whole[r] += w;
        odd[r] += w >> 8;
      }
    }
    for (std::size_t r = 0; r < Rows; ++r) {
      const Words even = whole[r] - (odd[r] << 8);
      for (std::size_t k = 0; k < 8; ++k) {
        total[r][2 * k] += even[k];
        total[r][2 * k + 1] += odd[r][k];
      }
    }
  }
  return total;
}

/// The same for one row.
inline Scores16 score_16_shifts(const std::uint8_t* row, std::span<const std::int32_t> offsets) {
  return score_rows<1>(row, 0, offsets)[0];
}

}  // namespace dynslam
