// SPDX-License-Identifier: MIT
#include "server/access/pairing_notice.h"

#include <algorithm>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/access/ip_address.h"
#include "server/access/own_addresses.h"

namespace dynslam {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

const PairingCode kCode{"ABCD-0123", Role::kAdmin, true, {}};

/// The modules that a camera sees on a dark terminal: true is dark.
std::vector<std::vector<bool>> modules_of(const std::string& text) {
  std::vector<std::vector<bool>> rows;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::vector<bool> upper, lower;
    for (std::size_t i = 0; i < line.size();) {
      const std::string glyph = line.substr(i, line[i] == ' ' ? 1 : 3);
      i += glyph.size();
      upper.push_back(glyph == " " || glyph == "▄");
      lower.push_back(glyph == " " || glyph == "▀");
    }
    rows.push_back(upper);
    rows.push_back(lower);
  }
  return rows;
}

/// The dark square with a ring around it that three corners of a QR code have.
bool is_finder(const std::vector<std::vector<bool>>& rows, std::size_t x0, std::size_t y0) {
  for (std::size_t y = 0; y < 7; ++y) {
    for (std::size_t x = 0; x < 7; ++x) {
      const std::size_t edge = std::min({x, y, 6 - x, 6 - y});
      if (rows.at(y0 + y).at(x0 + x) != (edge != 1)) return false;
    }
  }
  return true;
}

TEST(QrText, LooksLikeAQrCode) {
  const auto rows = modules_of(qr_text("http://192.168.1.7:8080/#pair=ABCD-0123"));
  constexpr std::size_t kSide = 29, kQuiet = 2;  // version 3
  ASSERT_EQ(rows.size(), kSide + 2 * kQuiet + 1) << "a line more, as rows come in pairs";
  for (const auto& row : rows) EXPECT_EQ(row.size(), kSide + 2 * kQuiet);
  EXPECT_TRUE(is_finder(rows, kQuiet, kQuiet));
  EXPECT_TRUE(is_finder(rows, kQuiet + kSide - 7, kQuiet));
  EXPECT_TRUE(is_finder(rows, kQuiet, kQuiet + kSide - 7));
  for (const std::size_t quiet : {std::size_t{0}, std::size_t{1}, kSide + kQuiet})
    for (std::size_t i = 0; i < rows[0].size(); ++i) EXPECT_FALSE(rows[quiet][i] || rows[i][quiet]);
}

TEST(QrText, IsEmptyWhenThereIsTooMuchToSay) { EXPECT_EQ(qr_text(std::string(4000, 'x')), ""); }

TEST(PageUrls, BeginWithWhatAPhoneReaches) {
  EXPECT_THAT(
      page_urls({"127.0.0.1/8", "fe80::1/64", "fd00::7/64", "192.168.1.7/24", "::1/128", "junk"}, 8080),
      ElementsAre("http://192.168.1.7:8080/", "http://[fd00::7]:8080/", "http://127.0.0.1:8080/",
                  "http://[::1]:8080/"));
}

TEST(PairingNotice, SaysWhatToDo) {
  const std::string text = pairing_notice(kCode, {"192.168.1.7/24", "127.0.0.1/8"}, 8080);
  EXPECT_TRUE(
      text.starts_with("This robot has no owner yet. Whoever enters the code ABCD-0123 becomes its admin:\n"
                       "  http://192.168.1.7:8080/#pair=ABCD-0123\n"
                       "  http://127.0.0.1:8080/#pair=ABCD-0123\n"))
      << text;
  EXPECT_TRUE(text.ends_with(qr_text("http://192.168.1.7:8080/#pair=ABCD-0123")));
  const PairingCode guest{"ABCD-0123", Role::kViewer, false, {}};
  EXPECT_TRUE(
      pairing_notice(guest, {}, 8080).starts_with("Whoever enters the code ABCD-0123 becomes its viewer:\n"));
}

TEST(PairingNotice, SaysThatThereIsNoNetworkYet) {
  const std::string lack =
      "There is no network yet: join the robot to one; where to find it is told here then.\n";
  for (const std::vector<std::string>& only :
       std::vector<std::vector<std::string>>{{}, {"127.0.0.1/8"}, {"fe80::1/64", "127.0.0.1/8", "::1/128"}}) {
    EXPECT_THAT(pairing_notice(kCode, only, 8080), HasSubstr(lack));
    EXPECT_THAT(page_notice(only, 8080), HasSubstr(lack));
  }
  EXPECT_THAT(pairing_notice(kCode, {"fd00::7/64", "::1/128"}, 8080), Not(HasSubstr("no network")));
  EXPECT_EQ(page_notice({"192.168.1.7/24", "127.0.0.1/8"}, 80),
            "The robot's page is at\n  http://192.168.1.7:80/\n  http://127.0.0.1:80/\n");
}

TEST(OwnAddresses, AreNetworks) {
  const auto all = own_addresses();
  EXPECT_TRUE(std::all_of(all.begin(), all.end(), [](const std::string& one) { return parse_network(one); }));
  EXPECT_EQ(own_host_name().find('\0'), std::string::npos);
}

}  // namespace
}  // namespace dynslam
