// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <bit>
#include <cstdint>

namespace dynslam {

/// For each byte of bits, eight bytes in memory that are 0xFF where the bit is set, the lowest bit first.
constexpr std::array<std::uint64_t, 256> make_spread_bits() {
  std::array<std::uint64_t, 256> spread{};
  for (unsigned bits = 0; bits < 256; ++bits) {
    for (unsigned b = 0; b < 8; ++b) {
      if ((bits >> b) & 1U)
        spread[bits] |= std::uint64_t{0xFF} << (8 * (std::endian::native == std::endian::little ? b : 7 - b));
    }
  }
  return spread;
}
inline constexpr std::array<std::uint64_t, 256> kSpreadBits = make_spread_bits();

}  // namespace dynslam
