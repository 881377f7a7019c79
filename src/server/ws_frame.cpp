// SPDX-License-Identifier: MIT
#include "server/ws_frame.h"

namespace dynslam {
namespace {

constexpr std::size_t kMask = 4;
constexpr std::size_t kMostControl = 125;  ///< bytes in a close, ping or pong

std::uint64_t big_endian(std::string_view bytes) {
  std::uint64_t value = 0;
  for (const char c : bytes) value = value << 8 | static_cast<unsigned char>(c);
  return value;
}

bool is_known(unsigned opcode) { return opcode == 1 || opcode == 2 || (opcode >= 8 && opcode <= 10); }

}  // namespace

std::optional<WsMessage> WsFrameReader::fail(std::uint16_t code, const char* reason) {
  fault_ = WsClosing{code, reason};
  buffer_.clear();
  begin_ = 0;
  return std::nullopt;
}

std::optional<WsMessage> WsFrameReader::next() {
  const std::string_view bytes = std::string_view(buffer_).substr(begin_);
  if (fault_ || bytes.size() < 2) return std::nullopt;
  const auto first = static_cast<unsigned char>(bytes[0]), second = static_cast<unsigned char>(bytes[1]);
  const unsigned opcode = first & 0x0fU;
  if ((first & 0x70U) != 0) return fail(1002, "reserved bits are set");
  if ((first & 0x80U) == 0 || opcode == 0) return fail(1003, "messages come in one frame");
  if (!is_known(opcode)) return fail(1002, "unknown kind of frame");
  if ((second & 0x80U) == 0) return fail(1002, "a client masks its frames");

  const unsigned short_length = second & 0x7fU;
  const std::size_t wide = short_length == 127 ? 8 : short_length == 126 ? 2 : 0;
  if (bytes.size() < 2 + wide) return std::nullopt;
  const std::uint64_t length = wide == 0 ? short_length : big_endian(bytes.substr(2, wide));
  if (opcode >= 8 && length > kMostControl) return fail(1002, "a control frame is too long");
  if (length > max_payload_) return fail(1009, "the message is too long");

  const std::size_t head = 2 + wide + kMask, size = static_cast<std::size_t>(length);
  if (bytes.size() < head + size) return std::nullopt;
  WsMessage message{static_cast<WsOpcode>(opcode), std::string(bytes.substr(head, size))};
  for (std::size_t i = 0; i < size; ++i)
    message.payload[i] = static_cast<char>(message.payload[i] ^ bytes[head - kMask + i % kMask]);
  begin_ += head + size;
  if (begin_ == buffer_.size() || begin_ > max_payload_) {
    buffer_.erase(0, begin_);
    begin_ = 0;
  }
  return message;
}

std::string ws_frame(WsOpcode opcode, std::string_view payload) {
  std::string bytes;
  bytes.reserve(payload.size() + 10);
  bytes += static_cast<char>(0x80U | static_cast<unsigned>(opcode));
  const std::uint64_t size = payload.size();
  const int wide = size < 126 ? 0 : size < 65536 ? 2 : 8;
  bytes += static_cast<char>(wide == 0 ? size : wide == 2 ? 126 : 127);
  for (int i = wide - 1; i >= 0; --i) bytes += static_cast<char>(size >> (8 * i) & 0xffU);
  bytes += payload;
  return bytes;
}

std::string ws_close_frame(const WsClosing& closing) {
  std::string payload;
  payload += static_cast<char>(closing.code >> 8);
  payload += static_cast<char>(closing.code & 0xffU);
  payload += closing.reason.substr(0, kMostControl - 2);
  return ws_frame(WsOpcode::kClose, payload);
}

}  // namespace dynslam
