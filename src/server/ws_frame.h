// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace dynslam {

enum class WsOpcode : std::uint8_t { kText = 1, kBinary = 2, kClose = 8, kPing = 9, kPong = 10 };

struct WsMessage {
  WsOpcode opcode = WsOpcode::kText;
  std::string payload;
};

/// Why a WebSocket is closed: a code of RFC 6455, section 7.4.1, and a few words.
struct WsClosing {
  std::uint16_t code = 1000;
  std::string reason;
};

/// Takes the frames of a client apart (RFC 6455, section 5). Messages come in one frame each: a fragmented,
/// an unmasked or an oversized one is a fault, told as soon as its head is there, so that nobody makes this
/// hold more than one message of the limit. After a fault nothing more is read. Pure; one thread.
class WsFrameReader {
 public:
  explicit WsFrameReader(std::size_t max_payload) : max_payload_(max_payload) {}

  void feed(std::string_view bytes) { buffer_.append(bytes); }
  /// The next whole message; nothing when bytes are missing or after a fault.
  std::optional<WsMessage> next();
  const std::optional<WsClosing>& fault() const { return fault_; }

 private:
  std::optional<WsMessage> fail(std::uint16_t code, const char* reason);

  std::size_t max_payload_;
  std::string buffer_;
  std::size_t begin_ = 0;  ///< of what was not taken yet
  std::optional<WsClosing> fault_;
};

/// One message as an unmasked frame, for a client.
std::string ws_frame(WsOpcode opcode, std::string_view payload);
std::string ws_close_frame(const WsClosing& closing);

}  // namespace dynslam
