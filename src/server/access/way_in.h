// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "server/access/access_config.h"
#include "server/access/access_request.h"
#include "server/access/http_fields.h"
#include "server/access/ip_address.h"

namespace dynslam {

/// Whether a request may be looked at, whoever it is from. Pure; the caller locks.
///
/// - The client must be near: this machine, a private network, the same IPv6 subnet, or a network of the
/// config.
/// - Host must be a name of this machine or a near address. Another name that leads here belongs to a foreign
///   page that rebinds it (DNS rebinding), and the browser takes that page for ours.
/// - Origin, if there is one, must be the Host on a WebSocket's handshake and on an unsafe method. Browsers
///   always send it there, so a request with our cookie and without Origin is no browser's doing and refused;
///   programs, which have a token or nothing, need none.
class WayIn {
 public:
  struct Refusal {
    const char* counter = "";  ///< its kind
    std::string why;           ///< one sentence
  };

  /// REQUIRES: config.problem() is nothing.
  WayIn(const AccessConfig& config, const std::string& host_name);

  /// The machine's own, with their prefix: "fd00::5/64".
  void set_addresses(const std::vector<std::string>& addresses);

  std::optional<Refusal> refuse(const AccessRequest& request) const;
  /// Of the request that stops the robot: needs no Origin, whatever the cookie, and takes any. It can do no
  /// harm, and a page that is kept from stopping may.
  std::optional<Refusal> refuse_stop(const AccessRequest& request) const;

 private:
  bool is_near(const IpAddress& address) const;
  bool is_ours(const std::string& host) const;
  std::optional<Refusal> refuse_client(const AccessRequest& request) const;
  std::optional<Refusal> refuse_host(const AccessRequest& request) const;
  std::optional<Refusal> refuse_origin(const AccessRequest& request) const;

  std::vector<std::string> names_;
  std::vector<IpNetwork> networks_;      ///< of the config
  std::vector<IpNetwork> own_networks_;  ///< the machine itself and the IPv6 subnets it is in
};

/// The cookie that holds a session.
inline constexpr const char* kSessionCookie = "dynslam_session";

}  // namespace dynslam
