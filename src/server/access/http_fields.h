// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace dynslam {

/// Where a header says that something is.
struct HostPort {
  std::string host;  ///< lower case, without the dot at the end or the brackets of an IPv6 address
  int port = 0;
  bool operator==(const HostPort&) const = default;
};

/// The header Host: "name", "name:port", "[::1]:port". Nothing when it is anything else.
std::optional<HostPort> parse_host(std::string_view header, int default_port);

/// The header Origin: "http://name:port" or https. Nothing for "null" and all else.
struct Origin {
  HostPort at;
  int default_port = 80;  ///< of its scheme
};
std::optional<Origin> parse_origin(std::string_view header);

/// The values of the cookies of that name, the first few; a header that is too long has none.
std::vector<std::string_view> cookies_named(std::string_view header, std::string_view name);

/// What follows "Bearer " in the header Authorization, in any case.
std::optional<std::string_view> bearer_of(std::string_view header);

/// Letters, digits, '-', '_' and '.', as names of machines have; lower case and without the dot at the end.
/// Nothing when it is anything else.
std::optional<std::string> plain_host_name(std::string_view text);

}  // namespace dynslam
