// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace dynslam {

/// Who is at the other end of a TCP connection.
struct Peer {
  std::string address;  ///< numeric; an IPv4 one that came as IPv6 is the IPv4 one
  int port = 0;
  auto operator<=>(const Peer&) const = default;
};

struct OpenSocket {
  int file = -1;
  Peer peer;
};

/// The connections of this process to its own port `port`. civetweb accepts them and does not show them.
/// Looks at all open files: some tens of microseconds.
std::vector<OpenSocket> open_sockets(int port);

/// The address without what marks an IPv4 one in IPv6.
std::string plain_address(const std::string& address);

}  // namespace dynslam
