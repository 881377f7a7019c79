// SPDX-License-Identifier: MIT
#include <cstdlib>
#include <string_view>

#include "server/ws_frame.h"

// However the bytes come in pieces, the same messages come out, and never more than the limit is held.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::size_t kMost = 300;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  dynslam::WsFrameReader whole(kMost), pieces(kMost);
  whole.feed(bytes);
  std::string from_whole, from_pieces;
  while (const auto message = whole.next()) from_whole += message->payload + '|';
  for (std::size_t at = 0; at < size; at += 1 + data[at] % 7) {
    pieces.feed(bytes.substr(at, 1 + data[at] % 7));
    while (const auto message = pieces.next()) {
      if (message->payload.size() > kMost) std::abort();
      from_pieces += message->payload + '|';
    }
  }
  if (from_whole != from_pieces || whole.fault().has_value() != pieces.fault().has_value()) std::abort();
  return 0;
}
