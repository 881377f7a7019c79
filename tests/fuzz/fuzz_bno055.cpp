// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string_view>

#include "drivers/bno055/calibration_profile.h"
#include "drivers/bno055/motion_check.h"
#include "drivers/bno055/protocol.h"

// Whatever the wires say, what is believed is an orientation and a rate that can be, one after the other; and
// a profile that is read is one that would be written.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace dynslam::bno055;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  if (const auto profile = read_profile(text)) {
    if (!is_possible(*profile) || read_profile(profile_text(*profile)) != profile) std::abort();
  }
  (void)axis_map(text.substr(0, size / 2), text.substr(size / 2));
  MotionCheck check;
  MotionBytes burst{};
  std::chrono::milliseconds at{0};
  for (std::size_t i = 0; i + burst.size() <= size; i += burst.size()) {
    std::copy_n(data + i, burst.size(), burst.begin());
    at += std::chrono::milliseconds(10);
    const MotionReading reading = decode_motion(burst);
    if (reading.nonsense != Nonsense::kNone) continue;
    if (std::abs(reading.motion.world_q_robot.norm() - 1.0) > 1e-9) std::abort();
    if (!(reading.motion.rate_radps.norm() < 61.0)) std::abort();
    (void)check.check(dynslam::Time(at), reading.motion);
  }
  StatusBytes status{};
  std::copy_n(data, std::min(size, status.size()), status.begin());
  if (const auto s = decode_status(status)) {
    if (s->calibration.system > 3 || s->temperature_c > 85 || error_words(s->error).empty()) std::abort();
  }
  return 0;
}
