// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace dynslam {

using Bytes = std::span<const std::uint8_t>;

/// The number whose bytes begin at `from`, in the given order.
template <class T>
T load(const std::uint8_t* from, std::endian order) {
  std::array<std::uint8_t, sizeof(T)> raw;
  std::copy_n(from, sizeof(T), raw.begin());
  if (order != std::endian::native) std::reverse(raw.begin(), raw.end());
  return std::bit_cast<T>(raw);
}

/// Walks over bytes and never beyond them: what is asked for past the end is zero or empty, and ok() turns
/// false for good. So a decoder reads all its fields and asks once.
class ByteCursor {
 public:
  explicit ByteCursor(Bytes bytes) : bytes_(bytes) {}

  bool ok() const { return ok_; }
  std::size_t position() const { return position_; }
  std::size_t remaining() const { return bytes_.size() - position_; }

  Bytes take(std::uint64_t size) {
    if (!ok_ || size > remaining()) {
      ok_ = false;
      return {};
    }
    const Bytes taken = bytes_.subspan(position_, static_cast<std::size_t>(size));
    position_ += taken.size();
    return taken;
  }

  template <class T>
  T number(std::endian order = std::endian::little) {
    const Bytes taken = take(sizeof(T));
    return taken.empty() ? T{} : load<T>(taken.data(), order);
  }

  /// Bytes behind their count of 32 bits.
  std::string_view text() {
    const Bytes taken = take(number<std::uint32_t>());
    return {reinterpret_cast<const char*>(taken.data()), taken.size()};
  }

  void fail() { ok_ = false; }

 private:
  Bytes bytes_;
  std::size_t position_ = 0;
  bool ok_ = true;
};

}  // namespace dynslam
