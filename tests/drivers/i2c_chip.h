// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

namespace dynslam::test {

/// A chip behind an emulated bus, as the wires see it. Called by a thread of the bus.
class I2cChip {
 public:
  virtual ~I2cChip() = default;
  /// The bytes of a write, up to the stop or repeated start. Returns 0, or the errno that the bus then gives.
  virtual int write(std::span<const std::uint8_t> bytes) = 0;
  /// Fills all of `into`. Returns 0 or an errno.
  virtual int read(std::span<std::uint8_t> into) = 0;
};

}  // namespace dynslam::test
