// SPDX-License-Identifier: MIT
#include "server/access/way_in.h"

#include <gtest/gtest.h>

#include "server/access/secrets.h"

namespace dynslam {
namespace {

constexpr const char* kNone = nullptr;
constexpr const char* kCookie = "dynslam_session=x";
constexpr const char* kBearer = "Bearer x";

AccessConfig config() {
  AccessConfig c;
  c.allowed_hosts = {"Robot.Example.ORG."};
  c.client_networks = {"100.64.0.0/10"};
  return c;
}

/// The kind of refusal; empty when there is none.
std::string kind_of(const std::optional<WayIn::Refusal>& refusal) {
  if (!refusal) return {};
  EXPECT_FALSE(refusal->why.empty());
  return std::string(refusal->counter).substr(std::string("access.").size());
}

class WayInTest : public testing::Test {
 protected:
  WayInTest() { way_in_.set_addresses({"192.168.1.7/24", "2001:db8:1:2::7/64", "8.8.4.4/24", "2a00::1/32"}); }

  std::string from(const char* address) const {
    const AccessRequest request{address, "GET", false, "localhost", {}, {}, {}};
    EXPECT_EQ(kind_of(way_in_.refuse(request)), kind_of(way_in_.refuse_stop(request)));
    return kind_of(way_in_.refuse(request));
  }
  std::string to(const char* host) const {
    const AccessRequest request{"10.0.0.1", "GET", false, host, {}, {}, {}};
    EXPECT_EQ(kind_of(way_in_.refuse(request)), kind_of(way_in_.refuse_stop(request)));
    return kind_of(way_in_.refuse(request));
  }

  WayIn way_in_{config(), "Robbie.home"};
};

TEST_F(WayInTest, LetsNearClientsAsk) {
  for (const char* near : {"127.0.0.1", "::1", "192.168.7.7", "::ffff:10.0.0.1", "fe80::1%wlan0", "fd12::1",
                           "100.64.1.1", "2001:db8:1:2::99", "8.8.4.4", "2a00::1"})
    EXPECT_EQ(from(near), "") << near;
  for (const char* far : {"8.8.8.8", "8.8.4.5", "2001:db8:1:3::99", "2a00::2", "", "garbage", "10.0.0.1:80"})
    EXPECT_EQ(from(far), "far_client") << far;
}

TEST_F(WayInTest, ForgetsSubnetsThatItLeft) {
  way_in_.set_addresses({});
  EXPECT_EQ(from("2001:db8:1:2::99"), "far_client");
}

TEST_F(WayInTest, AnswersToItsNames) {
  for (const char* ours :
       {"localhost", "LOCALHOST:8080", "localhost.", "robbie", "robbie.home:1", "robbie.local:8080",
        "robot.example.org", "127.0.0.1:8080", "192.168.1.7", "[::1]", "[fe80::1]:8080", "[fd00::1]",
        "10.9.8.7:80", "100.64.1.1", "[2001:db8:1:2::7]", "8.8.4.4:80"})
    EXPECT_EQ(to(ours), "") << ours;
  for (const char* foreign : {"evil.org", "evil.org:8080", "localhost.evil.org", "robbie.local.evil.org",
                              "robbie.lan", "example.org", "8.8.8.8", "[2001:db8::1]", "0.0.0.0", "0x7f.1",
                              "2130706433", "", ":8080", "localhost:", "localhost@evil.org",
                              "evil.org#localhost", "a.robot.example.org", "localhost,evil.org"})
    EXPECT_EQ(to(foreign), "foreign_host") << foreign;
  AccessRequest bare{"10.0.0.1", "GET", false, {}, {}, {}, {}};
  EXPECT_EQ(kind_of(way_in_.refuse(bare)), "") << "only programs say no Host";
}

TEST(WayIn, NeedsNoNameOfItsOwn) {
  for (const char* name : {"", "not a name"}) {
    const WayIn way_in(AccessConfig{}, name);
    EXPECT_FALSE(way_in.refuse({"10.0.0.1", "GET", false, "localhost", {}, {}, {}}));
    EXPECT_TRUE(way_in.refuse({"10.0.0.1", "GET", false, ".local", {}, {}, {}}));
  }
}

TEST_F(WayInTest, ShowsNothingOfAClientsThatIsNoText) {
  const auto refusal =
      way_in_.refuse({"10.0.0.1", "GET", false, "a\"\n\x1b[31m" + std::string(99, 'x'), {}, {}, {}});
  ASSERT_TRUE(refusal);
  EXPECT_EQ(refusal->why.find_first_of("\n\x1b"), std::string::npos);
  EXPECT_LT(refusal->why.size(), 160U);
}

/// Every origin, with every credential.
TEST_F(WayInTest, WantsTheOriginToBeTheHost) {
  struct Row {
    const char *host, *origin, *cookie, *authorization;
    bool is_fine;  ///< for what changes something
  };
  const Row rows[] = {
      {"robbie:8080", "http://robbie:8080", kCookie, kNone, true},
      {"robbie:8080", "http://robbie:8080", kNone, kNone, true},
      {"robbie:8080", "HTTP://ROBBIE:8080", kNone, kBearer, true},
      {"robbie:80", "http://robbie", kCookie, kNone, true},
      {"robbie", "http://robbie:80", kCookie, kNone, true},
      {"robbie", "https://robbie", kCookie, kNone, true},  // a proxy does TLS
      {"robbie", "http://robbie.", kCookie, kNone, true},
      {"[::1]:8080", "http://[::1]:8080", kCookie, kNone, true},
      {"robbie:8080", "http://robbie", kCookie, kNone, false},
      {"robbie:8080", "http://robbie:8081", kCookie, kNone, false},  // another program of this machine
      {"robbie:8080", "http://robbie.local:8080", kCookie, kNone, false},
      {"robbie:8080", "http://evil.org", kCookie, kNone, false},
      {"robbie:8080", "http://evil.org", kNone, kNone, false},
      {"robbie:8080", "http://evil.org", kNone, kBearer, false},
      {"robbie:8080", "null", kCookie, kNone, false},
      {"robbie:8080", "null", kNone, kNone, false},
      {"robbie:8080", "", kCookie, kNone, false},
      {"robbie:8080", "file://", kNone, kNone, false},
      {kNone, "http://robbie:8080", kCookie, kNone, false},
      {"robbie:8080", kNone, kNone, kNone, true},    // a program
      {"robbie:8080", kNone, kNone, kBearer, true},  // a program with a token
      {"robbie:8080", kNone, "other=1", kNone, true},
      {"robbie:8080", kNone, kCookie, kBearer, true},
      {"robbie:8080", kNone, kCookie, kNone, false},  // no browser sends this
      {"robbie:8080", kNone, kCookie, "Basic eDp5", false},
      {kNone, kNone, kNone, kBearer, true},
  };
  const auto text = [](const char* one) {
    return one == nullptr ? std::nullopt : std::optional<std::string>(one);
  };
  struct Way {
    const char* method;
    bool upgrade, is_checked;
  };
  const Way ways[] = {{"GET", true, true},      {"POST", false, true},  {"PUT", false, true},
                      {"DELETE", false, true},  {"PATCH", false, true}, {"get", false, true},
                      {"", false, true},        {"GET", false, false},  {"HEAD", false, false},
                      {"OPTIONS", false, false}};
  for (const Row& row : rows) {
    for (const Way& way : ways) {
      const AccessRequest request{"10.0.0.1",
                                  way.method,
                                  way.upgrade,
                                  text(row.host),
                                  text(row.origin),
                                  text(row.cookie),
                                  text(row.authorization)};
      const std::string kind = kind_of(way_in_.refuse(request));
      const char* expected = row.is_fine || !way.is_checked ? ""
                             : row.origin                   ? "foreign_origin"
                                                            : "no_origin";
      EXPECT_EQ(kind, expected) << way.method << way.upgrade << ' ' << (row.host ? row.host : "-") << ' '
                                << (row.origin ? row.origin : "-") << ' ' << (row.cookie ? row.cookie : "-");
      EXPECT_EQ(kind_of(way_in_.refuse_stop(request)), "") << "stopping needs no Origin and takes any";
    }
  }
}

TEST(AccessConfig, NamesWhatIsWrong) {
  EXPECT_FALSE(AccessConfig{}.problem());
  EXPECT_FALSE(config().problem());
  AccessConfig c = config();
  c.allowed_hosts.emplace_back("a b");
  EXPECT_EQ(c.problem(), "access.allowed_hosts: \"a?b\" is no name of a machine, as \"robot.lan\"");
  c = config();
  c.client_networks.emplace_back("home");
  EXPECT_EQ(c.problem(), "access.client_networks: \"home\" is no network, as \"100.64.0.0/10\"");
}

}  // namespace
}  // namespace dynslam
