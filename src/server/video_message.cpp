// SPDX-License-Identifier: MIT
#include "server/video_message.h"

#include <nlohmann/json.hpp>

#include "server/wire_bytes.h"

namespace dynslam {
namespace {

constexpr std::uint32_t kVideoKind = 3;

}  // namespace

std::string to_bytes(const JpegFrame& frame, std::uint32_t number) {
  std::string bytes;
  bytes.reserve(frame.bytes.size() + 16);
  append_le(bytes, kVideoKind);
  append_le(bytes, number);
  append_le(bytes, seconds_of(frame.stamp));
  bytes.append(reinterpret_cast<const char*>(frame.bytes.data()), frame.bytes.size());
  return bytes;
}

std::optional<std::uint32_t> parse_video_ack(std::string_view text) {
  if (text.size() > kLongestVideoAck) return std::nullopt;
  const nlohmann::json message = nlohmann::json::parse(text, nullptr, false);
  if (!message.is_object() || message.size() != 1 || !message.contains("ack")) return std::nullopt;
  const nlohmann::json& number = message["ack"];
  if (!number.is_number_unsigned() || number.get<std::uint64_t>() > UINT32_MAX) return std::nullopt;
  return number.get<std::uint32_t>();
}

}  // namespace dynslam
