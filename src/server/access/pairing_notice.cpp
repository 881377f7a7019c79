// SPDX-License-Identifier: MIT
#include "server/access/pairing_notice.h"

#include <algorithm>
#include <memory>

#include <qrencode.h>

#include "server/access/ip_address.h"

namespace dynslam {
namespace {

constexpr int kQuiet = 2;  // modules of light around; the standard's 4 make it too wide for small terminals

/// How likely a phone gets there; the smaller the better.
int rank_of(const IpAddress& address) {
  if (address.is_loopback()) return 2;
  return address.is_v4() ? 0 : 1;
}

const IpNetwork& link_local() {
  static const IpNetwork kNetwork = *parse_network("fe80::/10");
  return kNetwork;
}

bool is_dark(const QRcode& code, int x, int y) {
  if (x < 0 || y < 0 || x >= code.width || y >= code.width) return false;
  return (code.data[y * code.width + x] & 1) != 0;
}

/// What is said where only this machine itself is reached.
std::string lack_of_network(const std::vector<std::string>& addresses) {
  const bool is_there = std::any_of(addresses.begin(), addresses.end(), [](const std::string& text) {
    const auto address = parse_ip(text.substr(0, text.find('/')));
    return address && !address->is_loopback() && !link_local().contains(*address);
  });
  return is_there ? ""
                  : "There is no network yet: join the robot to one; where to find it is told here then.\n";
}

}  // namespace

std::vector<std::string> page_urls(const std::vector<std::string>& addresses, int port) {
  std::vector<std::pair<int, std::string>> ranked;
  for (const std::string& text : addresses) {
    const std::string host = text.substr(0, text.find('/'));
    const auto address = parse_ip(host);
    if (!address || link_local().contains(*address)) continue;
    const std::string shown = host.find(':') == std::string::npos ? host : '[' + host + ']';
    ranked.emplace_back(rank_of(*address), "http://" + shown + ':' + std::to_string(port) + '/');
  }
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::string> urls;
  urls.reserve(ranked.size());
  for (auto& [rank, url] : ranked) urls.push_back(std::move(url));
  return urls;
}

std::string page_notice(const std::vector<std::string>& addresses, int port) {
  std::string text;
  for (const std::string& url : page_urls(addresses, port)) text += "  " + url + '\n';
  return "The robot's page is at\n" + text + lack_of_network(addresses);
}

std::string pairing_url(const std::string& page_url, const PairingCode& code) {
  return page_url + "#pair=" + code.text;
}

std::string qr_text(const std::string& text) {
  const std::unique_ptr<QRcode, decltype(&::QRcode_free)> code(
      ::QRcode_encodeString8bit(text.c_str(), 0, QR_ECLEVEL_L), &::QRcode_free);
  if (!code) return {};
  std::string out;
  for (int y = -kQuiet; y < code->width + kQuiet; y += 2) {
    for (int x = -kQuiet; x < code->width + kQuiet; ++x) {
      const bool upper = !is_dark(*code, x, y), lower = !is_dark(*code, x, y + 1);
      out += upper && lower ? "█" : upper ? "▀" : lower ? "▄" : " ";
    }
    out += '\n';
  }
  return out;
}

std::string pairing_notice(const PairingCode& code, const std::vector<std::string>& addresses, int port) {
  const std::vector<std::string> urls = page_urls(addresses, port);
  std::string text = code.makes_owner ? "This robot has no owner yet. " : "";
  text +=
      "Whoever enters the code " + code.text + " becomes its " + std::string(to_string(code.role)) + ":\n";
  for (const std::string& url : urls) text += "  " + pairing_url(url, code) + '\n';
  text += lack_of_network(addresses);
  return urls.empty() ? text : text + qr_text(pairing_url(urls.front(), code));
}

}  // namespace dynslam
