// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>

namespace dynslam::thunderborg {

/// What PiBorg's motor board understands. A question is a transfer of its own, and so is its answer.
enum class Command : std::uint8_t {
  kSetLights = 5,       ///< red, green, blue
  kShowBattery = 6,     ///< 1: the lights show the battery, 0: what kSetLights says
  kForwardA = 8,        ///< 0 to 255, and so the next ones
  kReverseA = 9,        //
  kGetA = 10,           ///< answers 1 (forward) or 2 (reverse), 0 to 255
  kForwardB = 11,       //
  kReverseB = 12,       //
  kGetB = 13,           //
  kAllOff = 14,         //
  kGetFaultA = 15,      ///< answers 0 or 1
  kGetFaultB = 16,      //
  kSetFailsafe = 19,    ///< 1: motors off 0.25 s after the last command
  kGetFailsafe = 20,    ///< answers 0 or 1
  kGetBattery = 21,     ///< answers ten bits, high byte first
  kGetIdentity = 0x99,  ///< answers kIdentity
};

constexpr std::uint8_t kIdentity = 0x15;  ///< whatever the address
constexpr int kFullPower = 255;

/// Byte 0 repeats the question.
using Answer = std::array<std::uint8_t, 6>;

inline bool belongs_to(const Answer& answer, Command question) {
  return answer[0] == static_cast<std::uint8_t>(question);
}

/// -255 to 255. Nothing for a direction that does not exist, but at power 0.
std::optional<int> decode_motor(const Answer& answer);
/// Nothing for what is neither 0 nor 1.
std::optional<bool> decode_flag(const Answer& answer);
/// Volts; nothing for what does not fit into ten bits.
std::optional<double> decode_battery_v(const Answer& answer);

/// -1 to 1 as -255 to 255; values beyond are cut. REQUIRES: finite.
int motor_power(double share);

}  // namespace dynslam::thunderborg
