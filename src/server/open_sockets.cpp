// SPDX-License-Identifier: MIT
#include "server/open_sockets.h"

#include <array>
#include <cstdlib>
#include <filesystem>
#include <optional>

#include <arpa/inet.h>
#include <sys/socket.h>

namespace dynslam {
namespace {

constexpr std::string_view kMapped = "::ffff:";

using AnyAddress = sockaddr_storage;

Peer peer_of(const AnyAddress& any) {
  std::array<char, INET6_ADDRSTRLEN> text{};
  if (any.ss_family == AF_INET) {
    const auto& v4 = reinterpret_cast<const sockaddr_in&>(any);
    inet_ntop(AF_INET, &v4.sin_addr, text.data(), text.size());
    return {text.data(), ntohs(v4.sin_port)};
  }
  if (any.ss_family != AF_INET6) return {};
  const auto& v6 = reinterpret_cast<const sockaddr_in6&>(any);
  inet_ntop(AF_INET6, &v6.sin6_addr, text.data(), text.size());
  return {plain_address(text.data()), ntohs(v6.sin6_port)};
}

std::optional<Peer> end_of(int file, int (*get)(int, sockaddr*, socklen_t*)) {
  AnyAddress any{};
  socklen_t length = sizeof(any);
  if (get(file, reinterpret_cast<sockaddr*>(&any), &length) != 0) return std::nullopt;
  return peer_of(any);
}

}  // namespace

std::string plain_address(const std::string& address) {
  return address.starts_with(kMapped) ? address.substr(kMapped.size()) : address;
}

std::vector<OpenSocket> open_sockets(int port) {
  std::vector<OpenSocket> sockets;
  std::error_code failed;
  std::filesystem::directory_iterator entry("/proc/self/fd", failed);
  for (; !failed && entry != std::filesystem::directory_iterator(); entry.increment(failed)) {
    const int file = std::atoi(entry->path().filename().c_str());
    const auto own = end_of(file, getsockname);
    if (!own || own->port != port) continue;
    const auto peer = end_of(file, getpeername);
    if (peer && peer->port != 0) sockets.push_back({file, *peer});
  }
  return sockets;
}

}  // namespace dynslam
