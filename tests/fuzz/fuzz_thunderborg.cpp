// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>

#include "drivers/thunderborg/protocol.h"

// Whatever the board answers, what is made of it can be; and a power that goes out stays within its byte.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace dynslam::thunderborg;
  Answer answer{};
  std::copy_n(data, std::min(size, answer.size()), answer.begin());
  if (const auto power = decode_motor(answer); power && std::abs(*power) > kFullPower) std::abort();
  if (const auto volts = decode_battery_v(answer); volts && !(*volts >= 0.0 && *volts <= 36.3001))
    std::abort();
  (void)decode_flag(answer);
  double share = 0.0;
  if (size < sizeof(share)) return 0;
  std::memcpy(&share, data, sizeof(share));
  if (std::isfinite(share) && std::abs(motor_power(share)) > kFullPower) std::abort();
  return 0;
}
