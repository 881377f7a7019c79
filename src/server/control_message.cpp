// SPDX-License-Identifier: MIT
#include "server/control_message.h"

#include <cmath>

#include <nlohmann/json.hpp>

namespace dynslam {
namespace {

using nlohmann::json;

/// The largest number that the page counts to without a gap.
constexpr std::uint64_t kMostSeq = (1ULL << 53) - 1;

ControlMessage parse_drive(const json& message) {
  if (message.size() != 3 || !message.contains("v") || !message.contains("w"))
    return BadMessage{"a drive message has seq, v and w, and nothing else"};
  const json& seq = message["seq"];
  if (!seq.is_number_unsigned() || seq.get<std::uint64_t>() > kMostSeq)
    return BadMessage{"seq must be a whole number"};
  if (!message["v"].is_number() || !message["w"].is_number()) return BadMessage{"v and w must be numbers"};
  const DriveWish wish{seq.get<std::uint64_t>(), {message["v"].get<double>(), message["w"].get<double>()}};
  if (!is_finite(wish.twist)) return BadMessage{"v and w must be finite"};
  return wish;
}

ControlMessage parse_lease(const json& wish) {
  if (wish == "acquire") return LeaseWish::kAcquire;
  if (wish == "release") return LeaseWish::kRelease;
  if (wish == "take_over") return LeaseWish::kTakeOver;
  return BadMessage{"lease must be acquire, release or take_over"};
}

}  // namespace

ControlMessage parse_control(std::string_view text) {
  if (text.size() > kLongestControlMessage) return BadMessage{"the message is too long"};
  const json message = json::parse(text, nullptr, false);
  if (!message.is_object()) return BadMessage{"the message is no JSON object"};
  if (message.contains("seq")) return parse_drive(message);
  if (message.size() == 1 && message.contains("lease")) return parse_lease(message["lease"]);
  if (message.size() == 1 && message.contains("stop") && message["stop"] == true) return StopWish{};
  return BadMessage{"the message is of no known kind"};
}

}  // namespace dynslam
