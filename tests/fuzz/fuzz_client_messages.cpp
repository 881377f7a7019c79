// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstdlib>
#include <string_view>

#include "server/control_message.h"
#include "server/map_message.h"
#include "server/video_message.h"

// All that clients say on the WebSockets: refused, or something that the robot can bear.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const dynslam::ControlMessage message = dynslam::parse_control(bytes);
  if (const auto* drive = std::get_if<dynslam::DriveWish>(&message)) {
    if (!dynslam::is_finite(drive->twist)) std::abort();
  }
  if (const auto have = dynslam::parse_map_have(bytes)) {
    if (have->chunks.size() > 32768) std::abort();
  }
  dynslam::parse_video_ack(bytes);
  return 0;
}
