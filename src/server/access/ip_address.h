// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace dynslam {

/// An IPv6 address, or an IPv4 one as ::ffff:a.b.c.d.
struct IpAddress {
  std::array<std::uint8_t, 16> bytes{};
  auto operator<=>(const IpAddress&) const = default;

  bool is_v4() const;
  bool is_loopback() const;
};

/// Numeric ones only; what follows a '%' (the interface) is left out. IPv4 as four decimal numbers, since
/// browsers turn all other forms into that.
std::optional<IpAddress> parse_ip(std::string_view text);

/// What one holder of an address can easily change is zero: of IPv6 the lower half.
IpAddress holder_of(const IpAddress& address);

/// All addresses that share their first bits.
struct IpNetwork {
  IpAddress base;
  int bits = 128;  ///< of the 128, for IPv4 too

  bool contains(const IpAddress& address) const;
};

/// "10.0.0.0/8", "fd00::/8", or a single address. The rest of the bits may be anything.
std::optional<IpNetwork> parse_network(std::string_view text);

/// Loopback, private (RFC 1918), link-local and unique local networks. Not 100.64.0.0/10 (RFC 6598): behind
/// it an internet provider has its other customers.
const std::vector<IpNetwork>& private_networks();

}  // namespace dynslam
