// SPDX-License-Identifier: MIT
#include "server/access/ip_address.h"

#include <algorithm>
#include <charconv>
#include <string>

#include <arpa/inet.h>

namespace dynslam {
namespace {

constexpr std::array<std::uint8_t, 12> kV4Prefix = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xff, 0xff};
constexpr std::size_t kLongestText = 64;

IpAddress masked(IpAddress address, int bits) {
  for (int i = 0; i < 16; ++i) {
    const int kept = std::clamp(bits - 8 * i, 0, 8);
    address.bytes[i] = static_cast<std::uint8_t>(address.bytes[i] & (0xff00 >> kept));
  }
  return address;
}

IpNetwork network(const char* text) { return *parse_network(text); }

}  // namespace

bool IpAddress::is_v4() const { return std::equal(kV4Prefix.begin(), kV4Prefix.end(), bytes.begin()); }

bool IpAddress::is_loopback() const {
  static const IpNetwork kV4 = network("127.0.0.0/8"), kV6 = network("::1");
  return kV4.contains(*this) || kV6.contains(*this);
}

std::optional<IpAddress> parse_ip(std::string_view text) {
  const std::string plain(text.substr(0, std::min(text.find('%'), kLongestText)));
  IpAddress address;
  if (::inet_pton(AF_INET6, plain.c_str(), address.bytes.data()) == 1 &&
      plain.find('\0') == std::string::npos)
    return address;
  std::copy(kV4Prefix.begin(), kV4Prefix.end(), address.bytes.begin());
  if (plain.size() != text.size() || plain.find('\0') != std::string::npos ||
      ::inet_pton(AF_INET, plain.c_str(), address.bytes.data() + kV4Prefix.size()) != 1)
    return std::nullopt;
  return address;
}

IpAddress holder_of(const IpAddress& address) { return address.is_v4() ? address : masked(address, 64); }

bool IpNetwork::contains(const IpAddress& address) const {
  return masked(address, bits) == masked(base, bits);
}

std::optional<IpNetwork> parse_network(std::string_view text) {
  const std::size_t slash = std::min(text.find('/'), text.size());
  const auto base = parse_ip(text.substr(0, slash));
  if (!base) return std::nullopt;
  const bool is_v4 = text.find(':') == std::string_view::npos;
  const int most = is_v4 ? 32 : 128;
  int bits = most;
  if (slash < text.size()) {
    const char* const end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data() + slash + 1, end, bits);
    if (error != std::errc() || rest != end || bits < 0 || bits > most) return std::nullopt;
  }
  return IpNetwork{*base, is_v4 ? bits + 96 : bits};
}

const std::vector<IpNetwork>& private_networks() {
  static const std::vector<IpNetwork> kAll = {
      network("127.0.0.0/8"),    network("::1"),            // loopback
      network("10.0.0.0/8"),     network("172.16.0.0/12"),  // RFC 1918
      network("192.168.0.0/16"), network("169.254.0.0/16"),
      network("fe80::/10"),  // link-local
      network("fc00::/7")};  // unique local
  return kAll;
}

}  // namespace dynslam
