// SPDX-License-Identifier: MIT
#include "server/access/ip_address.h"

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

namespace dynslam {
namespace {

IpAddress ip(const char* text) { return parse_ip(text).value(); }

bool is_private(const char* text) {
  const auto& all = private_networks();
  return std::any_of(all.begin(), all.end(), [&](const IpNetwork& n) { return n.contains(ip(text)); });
}

TEST(ParseIp, TakesNumbersOnly) {
  for (const char* good : {"0.0.0.0", "255.255.255.255", "::", "::1", "fe80::1%wlan0", "::ffff:1.2.3.4",
                           "2001:db8:0:0:0:0:0:1", "FE80::A"}) {
    EXPECT_TRUE(parse_ip(good)) << good;
  }
  for (const char* bad : {"", "1.2.3", "1.2.3.4.5", "1.2.3.256", "01.2.3.4", "0x7f.0.0.1", "2130706433",
                          "127.1", " 1.2.3.4", "1.2.3.4 ", "1.2.3.4%eth0", "1.2.3.4:80", "[::1]",
                          ":::", "fe80::1::2", "localhost", "%", "-1.2.3.4"}) {
    EXPECT_FALSE(parse_ip(bad)) << bad;
  }
  EXPECT_FALSE(parse_ip(std::string_view("1.2.3.4\0.evil", 13)));
  EXPECT_FALSE(parse_ip(std::string_view("::1\0", 4)));
  EXPECT_FALSE(parse_ip(std::string(100000, '1')));
}

TEST(ParseIp, KnowsMappedAddresses) {
  EXPECT_EQ(ip("::ffff:192.168.1.7"), ip("192.168.1.7"));
  EXPECT_EQ(ip("::FFFF:c0a8:0107"), ip("192.168.1.7"));
  EXPECT_TRUE(ip("::ffff:127.0.0.1").is_loopback());
  EXPECT_TRUE(ip("127.255.0.1").is_loopback());
  EXPECT_TRUE(ip("::1").is_loopback());
  EXPECT_FALSE(ip("::2").is_loopback());
  EXPECT_FALSE(ip("128.0.0.1").is_loopback());
  EXPECT_FALSE(ip("::").is_loopback());
}

TEST(PrivateNetworks, EndWhereTheyEnd) {
  for (const char* near : {"127.0.0.1", "10.0.0.0", "10.255.255.255", "172.16.0.0", "172.31.255.255",
                           "192.168.0.0", "192.168.255.255", "169.254.1.1", "::1", "fe80::1", "febf::1",
                           "fc00::", "fdff::1", "::ffff:10.1.2.3"}) {
    EXPECT_TRUE(is_private(near)) << near;
  }
  for (const char* far : {"9.255.255.255",
                          "11.0.0.0",
                          "172.15.255.255",
                          "172.32.0.0",
                          "192.167.255.255",
                          "192.169.0.0",
                          "169.253.0.0",
                          "169.255.0.0",
                          "126.0.0.0",
                          "128.0.0.0",
                          "100.64.0.1",
                          "0.0.0.0",
                          "8.8.8.8",
                          "224.0.0.1",
                          "255.255.255.255",
                          "::",
                          "::2",
                          "fec0::1",
                          "fe7f::1",
                          "fbff::1",
                          "fe00::1",
                          "2001:db8::1",
                          "::ffff:8.8.8.8"}) {
    EXPECT_FALSE(is_private(far)) << far;
  }
}

TEST(ParseNetwork, TakesAPrefix) {
  EXPECT_TRUE(parse_network("100.64.0.0/10")->contains(ip("100.127.255.255")));
  EXPECT_FALSE(parse_network("100.64.0.0/10")->contains(ip("100.128.0.0")));
  EXPECT_TRUE(parse_network("100.100.0.1/10")->contains(ip("100.64.0.0"))) << "the rest of the bits is free";
  EXPECT_TRUE(parse_network("8.8.8.8")->contains(ip("8.8.8.8")));
  EXPECT_FALSE(parse_network("8.8.8.8")->contains(ip("8.8.8.9")));
  EXPECT_TRUE(parse_network("0.0.0.0/0")->contains(ip("8.8.8.8")));
  EXPECT_FALSE(parse_network("0.0.0.0/0")->contains(ip("2001:db8::1")));
  EXPECT_TRUE(parse_network("::/0")->contains(ip("8.8.8.8")));
  EXPECT_TRUE(parse_network("2001:db8::5/64")->contains(ip("2001:db8::ffff")));
  EXPECT_FALSE(parse_network("2001:db8::5/64")->contains(ip("2001:db8:0:1::5")));
}

TEST(ParseNetwork, RefusesAllElse) {
  for (const char* bad : {"", "/", "/8", "10.0.0.0/", "10.0.0.0/33", "10.0.0.0/-1", "10.0.0.0/+8",
                          "10.0.0.0/8 ", "10.0.0.0/8/8", "::/129", "::/99999999999", "home", "10.0.0.0/a"}) {
    EXPECT_FALSE(parse_network(bad)) << bad;
  }
}

TEST(HolderOf, IsASubnetOfIpv6) {
  EXPECT_EQ(holder_of(ip("fd00::1:2:3:4")), ip("fd00::"));
  EXPECT_NE(holder_of(ip("fd00:0:0:1::1")), holder_of(ip("fd00:0:0:2::1")));
  EXPECT_EQ(holder_of(ip("10.0.0.1")), ip("10.0.0.1"));
}

}  // namespace
}  // namespace dynslam
