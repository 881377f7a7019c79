// SPDX-License-Identifier: MIT
#include "server/access/http_fields.h"

#include <gtest/gtest.h>

namespace dynslam {
namespace {

using Values = std::vector<std::string_view>;

TEST(ParseHost, TakesNamesAndAddresses) {
  EXPECT_EQ(parse_host("Robot.Local:8080", 80), (HostPort{"robot.local", 8080}));
  EXPECT_EQ(parse_host("robot.local.", 80), (HostPort{"robot.local", 80}));
  EXPECT_EQ(parse_host("10.0.0.1", 443), (HostPort{"10.0.0.1", 443}));
  EXPECT_EQ(parse_host("[FD00::1]:1", 80), (HostPort{"fd00::1", 1}));
  EXPECT_EQ(parse_host("[::1]", 80), (HostPort{"::1", 80}));
  EXPECT_EQ(parse_host("a_b-c:65535", 80), (HostPort{"a_b-c", 65535}));
}

TEST(ParseHost, RefusesAllElse) {
  for (const char* bad : {"",          ":",           ":80",
                          ".",         "a b",         "a:",
                          "a:0",       "a:65536",     "a:-1",
                          "a:+1",      "a:1a",        "a:80:80",
                          "a:000080",  "user@a",      "a/b",
                          "a\\b",      "a,b",         "http://a",
                          "[",         "[]",          "[]:80",
                          "[::1",      "[::1]80",     "[::1]:",
                          "[1.2.3.4]", "[localhost]", "[fe80::1%eth0]",
                          "::1",       "a\xc3\xa4",   "a%20b",
                          "a\tb",      " a",          "a "}) {
    EXPECT_FALSE(parse_host(bad, 80)) << bad;
  }
  EXPECT_FALSE(parse_host(std::string_view("localhost\0.evil", 15), 80));
  EXPECT_TRUE(parse_host(std::string(253, 'a'), 80));
  EXPECT_FALSE(parse_host(std::string(254, 'a'), 80));
}

TEST(ParseOrigin, KnowsTwoSchemes) {
  EXPECT_EQ(parse_origin("http://Robot:8080")->at, (HostPort{"robot", 8080}));
  EXPECT_EQ(parse_origin("HTTP://robot")->at, (HostPort{"robot", 80}));
  EXPECT_EQ(parse_origin("https://robot")->at, (HostPort{"robot", 443}));
  EXPECT_EQ(parse_origin("https://robot")->default_port, 443);
  EXPECT_EQ(parse_origin("http://[::1]:8080")->at, (HostPort{"::1", 8080}));
  for (const char* bad : {"", "null", "http://", "http:/robot", "robot", "//robot", "ws://robot", "file://",
                          "http://robot/", "http://a http://b", "http://u@robot", "moz-extension://a"}) {
    EXPECT_FALSE(parse_origin(bad)) << bad;
  }
}

TEST(CookiesNamed, FindsThemAmongOthers) {
  EXPECT_EQ(cookies_named("s=1", "s"), Values{"1"});
  EXPECT_EQ(cookies_named("a=2; s=1;b=3", "s"), Values{"1"});
  EXPECT_EQ(cookies_named("s=1; s=2", "s"), (Values{"1", "2"}));
  EXPECT_EQ(cookies_named("  s=a=b  ", "s"), Values{"a=b"});
  EXPECT_EQ(cookies_named("s=", "s"), Values{""});
  for (const char* none : {"", ";", ";;;", "s", "ss=1", "xs=1", "S=1", "s =1", "=s", "a=s=1", "\"s=1\""})
    EXPECT_EQ(cookies_named(none, "s"), Values{}) << none;
}

TEST(CookiesNamed, IsBounded) {
  EXPECT_EQ(cookies_named("s=1;s=2;s=3;s=4;s=5", "s").size(), 4U);
  EXPECT_EQ(cookies_named("s=" + std::string(8190, 'x'), "s").size(), 1U);
  EXPECT_EQ(cookies_named("s=" + std::string(8191, 'x'), "s").size(), 0U);
}

TEST(BearerOf, TakesWhatFollows) {
  EXPECT_EQ(bearer_of("Bearer abc"), "abc");
  EXPECT_EQ(bearer_of(" bEARER   abc  "), "abc");
  for (const char* none : {"", "Bearer", "Bearer ", "Basic abc", "Bearerabc", "abc", "Bearer\tabc"})
    EXPECT_FALSE(bearer_of(none)) << none;
}

TEST(PlainHostName, IsWhatMachinesAreCalled) {
  EXPECT_EQ(plain_host_name("Robot-1.LAN."), "robot-1.lan");
  for (const char* bad : {"", ".", "a b", "*.lan", "a:80", "http://a"})
    EXPECT_FALSE(plain_host_name(bad)) << bad;
}

}  // namespace
}  // namespace dynslam
