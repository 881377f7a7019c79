// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

namespace dynslam {

/// What is known of a request, or of a WebSocket's handshake, before anything is done for it. A header that
/// came several times is given with its first value.
struct AccessRequest {
  std::string address;   ///< of the peer, numeric; with or without ::ffff: or %interface
  std::string method;    ///< as sent
  bool upgrade = false;  ///< to a WebSocket
  std::optional<std::string> host, origin, cookie, authorization;
};

}  // namespace dynslam
