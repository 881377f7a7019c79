// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <span>
#include <utility>

namespace dynslam::test {

/// How bytes come out wrong on the wires.
enum class Garble { kNone, kZeros, kOnes, kSwapped, kTopBit };

/// What an emulated chip does wrong, and how often. One thread at a time.
class ChipFaults {
 public:
  static constexpr int kForever = 1 << 30;

  /// The next transfers end with this errno.
  void fail(int error, int times) { error_ = error, fails_ = times; }
  /// The next reads come out wrong.
  void garble(Garble how, int times) { how_ = how, garbles_ = times; }

  /// The errno of this transfer.
  int next_error() { return fails_ > 0 && fails_-- > 0 ? error_ : 0; }

  void spoil(std::span<std::uint8_t> bytes) {
    if (garbles_ <= 0) return;
    --garbles_;
    if (how_ == Garble::kZeros) std::fill(bytes.begin(), bytes.end(), std::uint8_t{0});
    if (how_ == Garble::kOnes) std::fill(bytes.begin(), bytes.end(), std::uint8_t{0xff});
    if (how_ == Garble::kSwapped)
      for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) std::swap(bytes[i], bytes[i + 1]);
    if (how_ == Garble::kTopBit)
      for (std::uint8_t& b : bytes) b |= 0x80;
  }

 private:
  int error_ = 0, fails_ = 0, garbles_ = 0;
  Garble how_ = Garble::kNone;
};

}  // namespace dynslam::test
