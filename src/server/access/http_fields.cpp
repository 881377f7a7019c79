// SPDX-License-Identifier: MIT
#include "server/access/http_fields.h"

#include <algorithm>
#include <charconv>

#include "server/access/ip_address.h"

namespace dynslam {
namespace {

constexpr std::size_t kLongestName = 253;  // of a host (RFC 1035)
constexpr std::size_t kLongestCookies = 8192;
constexpr std::size_t kMostCookies = 4;  // other paths may have set the same name

constexpr char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

constexpr bool is_name_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-' || c == '_' || c == '.';
}

std::string lowered(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(), lower);
  return out;
}

std::string_view trimmed(std::string_view text) {
  const auto is_space = [](char c) { return c == ' ' || c == '\t'; };
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
  return text;
}

/// ":80" or nothing at all.
std::optional<int> parse_port(std::string_view text, int default_port) {
  if (text.empty()) return default_port;
  if (text.size() < 2 || text.size() > 6 || text.front() != ':') return std::nullopt;
  int port = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data() + 1, end, port);
  if (error != std::errc() || rest != end || port < 1 || port > 65535) return std::nullopt;
  return port;
}

}  // namespace

std::optional<std::string> plain_host_name(std::string_view text) {
  if (text.ends_with('.')) text.remove_suffix(1);
  std::string name = lowered(text);
  const bool has_empty_part =
      name.empty() || name.starts_with('.') || name.ends_with('.') || name.find("..") != std::string::npos;
  if (has_empty_part || name.size() > kLongestName || !std::all_of(name.begin(), name.end(), is_name_letter))
    return std::nullopt;
  return name;
}

std::optional<HostPort> parse_host(std::string_view header, int default_port) {
  const bool is_v6 = header.starts_with('[');
  const std::size_t end = is_v6 ? header.find(']') : std::min(header.find(':'), header.size());
  if (end == std::string_view::npos) return std::nullopt;
  const auto port = parse_port(header.substr(is_v6 ? end + 1 : end), default_port);
  if (!port) return std::nullopt;
  if (!is_v6) {
    auto name = plain_host_name(header.substr(0, end));
    if (!name) return std::nullopt;
    return HostPort{std::move(*name), *port};
  }
  const std::string_view inside = header.substr(1, end - 1);
  if (inside.find(':') == std::string_view::npos || inside.find('%') != std::string_view::npos ||
      !parse_ip(inside))
    return std::nullopt;
  return HostPort{lowered(inside), *port};
}

std::optional<Origin> parse_origin(std::string_view header) {
  for (const auto& [scheme, default_port] :
       {std::pair<std::string_view, int>{"http://", 80}, std::pair<std::string_view, int>{"https://", 443}}) {
    if (lowered(header.substr(0, scheme.size())) != scheme) continue;
    auto at = parse_host(header.substr(scheme.size()), default_port);
    if (!at) return std::nullopt;
    return Origin{std::move(*at), default_port};
  }
  return std::nullopt;
}

std::vector<std::string_view> cookies_named(std::string_view header, std::string_view name) {
  std::vector<std::string_view> values;
  if (header.size() > kLongestCookies) return values;
  while (!header.empty() && values.size() < kMostCookies) {
    const std::size_t end = std::min(header.find(';'), header.size());
    const std::string_view pair = trimmed(header.substr(0, end));
    if (pair.starts_with(name) && pair.substr(name.size()).starts_with('='))
      values.push_back(pair.substr(name.size() + 1));
    header.remove_prefix(std::min(end + 1, header.size()));
  }
  return values;
}

std::optional<std::string_view> bearer_of(std::string_view header) {
  constexpr std::string_view kScheme = "bearer ";
  header = trimmed(header);
  if (lowered(header.substr(0, kScheme.size())) != kScheme) return std::nullopt;
  return trimmed(header.substr(kScheme.size()));
}

}  // namespace dynslam
