// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "base/jpeg_frame.h"

namespace dynslam {

inline constexpr std::size_t kLongestVideoAck = 64;

/// A picture on the socket `video` (web/wire.md), numbered for this client from 1.
std::string to_bytes(const JpegFrame& frame, std::uint32_t number);

/// The number of the picture that a client has shown; nothing when the text is no acknowledgement.
std::optional<std::uint32_t> parse_video_ack(std::string_view text);

}  // namespace dynslam
