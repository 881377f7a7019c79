// SPDX-License-Identifier: MIT
#include "server/access/own_addresses.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <memory>

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>
#include <unistd.h>

namespace dynslam {
namespace {

template <class Bytes>
int ones(const Bytes& bytes) {
  int count = 0;
  for (const std::uint8_t byte : bytes) count += std::popcount(byte);
  return count;
}

std::string text_of(int family, const void* address, int bits) {
  std::array<char, INET6_ADDRSTRLEN> text{};
  if (::inet_ntop(family, address, text.data(), text.size()) == nullptr) return {};
  return std::string(text.data()) + '/' + std::to_string(bits);
}

/// Empty when it is no IP address.
std::string text_of(const ifaddrs& one) {
  if (one.ifa_addr == nullptr || one.ifa_netmask == nullptr) return {};
  if (one.ifa_addr->sa_family == AF_INET) {
    const auto* mask = reinterpret_cast<const sockaddr_in*>(one.ifa_netmask);
    return text_of(AF_INET, &reinterpret_cast<const sockaddr_in*>(one.ifa_addr)->sin_addr,
                   std::popcount(mask->sin_addr.s_addr));
  }
  if (one.ifa_addr->sa_family != AF_INET6) return {};
  const auto* mask = reinterpret_cast<const sockaddr_in6*>(one.ifa_netmask);
  return text_of(AF_INET6, &reinterpret_cast<const sockaddr_in6*>(one.ifa_addr)->sin6_addr,
                 ones(mask->sin6_addr.s6_addr));
}

}  // namespace

std::vector<std::string> own_addresses() {
  ifaddrs* first = nullptr;
  if (::getifaddrs(&first) != 0) return {};
  const std::unique_ptr<ifaddrs, decltype(&::freeifaddrs)> all(first, &::freeifaddrs);
  std::vector<std::string> outer, loopback;
  for (const ifaddrs* one = first; one != nullptr; one = one->ifa_next) {
    if ((one->ifa_flags & IFF_UP) == 0) continue;
    std::string text = text_of(*one);
    if (!text.empty()) ((one->ifa_flags & IFF_LOOPBACK) != 0 ? loopback : outer).push_back(std::move(text));
  }
  outer.insert(outer.end(), loopback.begin(), loopback.end());
  return outer;
}

std::string own_host_name() {
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "";
}

}  // namespace dynslam
