// SPDX-License-Identifier: MIT
#include "server/access/way_in.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace dynslam {
namespace {

using Refusal = WayIn::Refusal;

constexpr int kSmallestSubnet = 64;  // a shorter prefix is a provider's, not a home's

bool is_safe(std::string_view method) {
  constexpr std::array<std::string_view, 3> kSafe = {"GET", "HEAD", "OPTIONS"};
  return std::find(kSafe.begin(), kSafe.end(), method) != kSafe.end();
}

bool has(const std::vector<IpNetwork>& networks, const IpAddress& address) {
  return std::any_of(networks.begin(), networks.end(), [&](const auto& n) { return n.contains(address); });
}

/// Text of a client's in a sentence for it.
std::string shown(std::string_view text) {
  constexpr std::size_t kLongest = 60;
  std::string out;
  for (const char c : text.substr(0, kLongest)) out += c > ' ' && c < '\x7f' && c != '"' ? c : '?';
  return '"' + out + (text.size() > kLongest ? "..." : "") + '"';
}

bool has_session_cookie(const AccessRequest& request) {
  return request.cookie && !cookies_named(*request.cookie, kSessionCookie).empty();
}

bool has_bearer(const AccessRequest& request) {
  return request.authorization && bearer_of(*request.authorization);
}

}  // namespace

std::optional<std::string> AccessConfig::problem() const {
  for (const std::string& name : allowed_hosts)
    if (!plain_host_name(name))
      return "access.allowed_hosts: " + shown(name) + " is no name of a machine, as \"robot.lan\"";
  for (const std::string& network : client_networks)
    if (!parse_network(network))
      return "access.client_networks: " + shown(network) + " is no network, as \"100.64.0.0/10\"";
  return std::nullopt;
}

WayIn::WayIn(const AccessConfig& config, const std::string& host_name) : names_{"localhost"} {
  if (const auto name = plain_host_name(host_name)) {
    const std::string first = name->substr(0, name->find('.'));
    names_.insert(names_.end(), {*name, first, first + ".local"});
  }
  for (const std::string& name : config.allowed_hosts) names_.push_back(*plain_host_name(name));
  for (const std::string& network : config.client_networks) networks_.push_back(*parse_network(network));
}

void WayIn::set_addresses(const std::vector<std::string>& addresses) {
  own_networks_.clear();
  for (const std::string& text : addresses) {
    const auto network = parse_network(text);
    if (!network) continue;
    own_networks_.push_back({network->base, 128});
    // A public IPv4 subnet is shared by strangers; a home's IPv6 addresses are all public.
    if (!network->base.is_v4() && network->bits >= kSmallestSubnet) own_networks_.push_back(*network);
  }
}

std::optional<Refusal> WayIn::refuse(const AccessRequest& request) const {
  auto refusal = refuse_stop(request);
  if (!refusal && (request.upgrade || !is_safe(request.method))) refusal = refuse_origin(request);
  return refusal;
}

std::optional<Refusal> WayIn::refuse_stop(const AccessRequest& request) const {
  auto refusal = refuse_client(request);
  return refusal ? refusal : refuse_host(request);
}

bool WayIn::is_near(const IpAddress& address) const {
  return has(private_networks(), address) || has(networks_, address) || has(own_networks_, address);
}

bool WayIn::is_ours(const std::string& host) const {
  const auto address = parse_ip(host);
  return address ? is_near(*address) : std::find(names_.begin(), names_.end(), host) != names_.end();
}

std::optional<Refusal> WayIn::refuse_client(const AccessRequest& request) const {
  const auto address = parse_ip(request.address);
  if (address && is_near(*address)) return std::nullopt;
  return Refusal{"access.far_client", "only clients of private networks are let in, not " +
                                          shown(request.address) + "; access.client_networks can name more"};
}

std::optional<Refusal> WayIn::refuse_host(const AccessRequest& request) const {
  // Browsers always say it, so without it no page has been deceived; and HTTP/1.0 knew none.
  if (!request.host) return std::nullopt;
  const auto host = parse_host(*request.host, 0);
  if (host && is_ours(host->host)) return std::nullopt;
  return Refusal{"access.foreign_host",
                 "this robot is not known as " + shown(*request.host) + "; access.allowed_hosts can name it"};
}

std::optional<Refusal> WayIn::refuse_origin(const AccessRequest& request) const {
  if (!request.origin) {
    if (!has_session_cookie(request) || has_bearer(request)) return std::nullopt;
    return Refusal{"access.no_origin", "a request with a cookie that changes something needs an Origin"};
  }
  const auto origin = parse_origin(*request.origin);
  if (origin && request.host && parse_host(*request.host, origin->default_port) == origin->at)
    return std::nullopt;
  return Refusal{"access.foreign_origin",
                 "a page of " + shown(*request.origin) + " may not do this to the robot"};
}

}  // namespace dynslam
