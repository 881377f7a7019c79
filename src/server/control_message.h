// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

#include "base/twist.h"

namespace dynslam {

/// What a client says on the socket `control` (web/wire.md).
struct DriveWish {
  std::uint64_t seq = 0;
  Twist twist;  ///< finite, not yet clamped
};
enum class LeaseWish { kAcquire, kRelease, kTakeOver };
struct StopWish {};
/// In words that the client is told.
struct BadMessage {
  std::string why;
};
using ControlMessage = std::variant<DriveWish, LeaseWish, StopWish, BadMessage>;

inline constexpr std::size_t kLongestControlMessage = 1024;

/// Never throws: what is not understood is a BadMessage.
ControlMessage parse_control(std::string_view text);

}  // namespace dynslam
