// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "server/access/pairing_codes.h"

namespace dynslam {

/// Where the robot's page is, as a person types it into a browser: "http://192.168.1.7:8080/", the address
/// that a phone most likely reaches first, loopback last. `addresses` as own_addresses() says; those that
/// browsers cannot be told (IPv6 link-local) are left out.
std::vector<std::string> page_urls(const std::vector<std::string>& addresses, int port);

/// For the console and the journal: where the page is, or what to do while no network is there.
std::string page_notice(const std::vector<std::string>& addresses, int port);

/// The page that pairs by itself. What follows the '#' stays in the browser, out of any log.
std::string pairing_url(const std::string& page_url, const PairingCode& code);

/// A QR code of half blocks for a terminal, light on dark, with its quiet zone; a line is two rows. Empty
/// when the text is too long for one.
std::string qr_text(const std::string& text);

/// For the console and the journal: what the code is for, where to type it, and the QR code of the first
/// address.
std::string pairing_notice(const PairingCode& code, const std::vector<std::string>& addresses, int port);

}  // namespace dynslam
