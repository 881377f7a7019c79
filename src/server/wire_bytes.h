// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

namespace dynslam {

/// Numbers as bytes, the lowest first, as the page's DataView reads them (web/wire.md).
template <class T>
void append_le(std::string& bytes, T value) {
  static_assert(std::is_arithmetic_v<T> && std::endian::native == std::endian::little);
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  bytes.append(raw, sizeof(T));
}

/// REQUIRES: the number lies within `bytes`.
template <class T>
T read_le(std::string_view bytes, std::size_t at) {
  static_assert(std::is_arithmetic_v<T> && std::endian::native == std::endian::little);
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof(T));
  return value;
}

}  // namespace dynslam
