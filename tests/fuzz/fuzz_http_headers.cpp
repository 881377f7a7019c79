// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include "server/access/access.h"
#include "server/access/credential_book.h"
#include "server/access/http_fields.h"
#include "server/access/ip_address.h"

namespace dynslam {
namespace {

void require(bool promise) {
  if (!promise) std::abort();
}

/// Lines, the last one with all that is left.
std::vector<std::string> lines_of(std::string_view text, std::size_t count) {
  std::vector<std::string> lines;
  while (lines.size() + 1 < count) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    lines.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  lines.emplace_back(text);
  return lines;
}

std::optional<std::string> header(const std::string& line) {
  return line.empty() ? std::nullopt : std::optional(line);
}

/// A request of nobody whom the robot knows, whatever it says.
void judge(Access& access, const std::vector<std::string>& lines) {
  const AccessTime now{{}, std::chrono::sys_seconds(std::chrono::days(20000))};
  const AccessRequest request{lines[0],         lines[1],         lines[2] == "upgrade", header(lines[3]),
                              header(lines[4]), header(lines[5]), header(lines[6])};
  const Judgement viewer = access.judge(request, Role::kViewer, now);
  require(!viewer.is_in() && !viewer.why.empty() && viewer.role == Role::kNone);
  const Judgement nobody = access.judge(request, Role::kNone, now);
  const Judgement stop = access.judge_stop(request, now);
  require(!nobody.is_in() || stop.is_in());
  require(nobody.why.find_first_of("\r\n") == std::string::npos);
  require(!access.pair(lines[3], lines[4], lines[0], now).is_in());
}

void parse(const std::string& text) {
  if (const auto host = parse_host(text, 80)) {
    require(host->port >= 1 && host->port <= 65535 && !host->host.empty());
    const bool is_v6 = host->host.find(':') != std::string::npos;
    // What was understood means the same when it is said again.
    const std::string again = is_v6 ? '[' + host->host + ']' : host->host;
    require(parse_host(again + ':' + std::to_string(host->port), 1) == host);
    const auto origin = parse_origin("http://" + text);
    require(origin && origin->at == host);
  }
  if (const auto network = parse_network(text)) require(network->contains(network->base));
  for (const std::string_view value : cookies_named(text, "s"))
    require(value.data() >= text.data() && value.data() + value.size() <= text.data() + text.size());
  if (const auto code = typed_code(text)) require(typed_code(*code) == code);
  if (const auto digest = digest_from_hex(text)) require(hex_of(*digest) == text);
  is_name(text);
}

}  // namespace
}  // namespace dynslam

// Seven lines: address, method, "upgrade" or not, Host, Origin, Cookie, Authorization.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace dynslam;
  static Access access([] {
    AccessSetup setup;
    setup.host_name = "robot";
    return setup;
  }());
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto lines = lines_of(text, 7);
  judge(access, lines);
  for (const std::string& line : lines) parse(line);
  return 0;
}
