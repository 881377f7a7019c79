// SPDX-License-Identifier: MIT
#include "server/ws_frame.h"

#include <gtest/gtest.h>

namespace dynslam {
namespace {

/// As a client sends it: masked.
std::string masked(unsigned first, std::string payload, std::uint64_t claimed) {
  const std::string mask = "\x11\x22\x33\x44";
  std::string bytes(1, static_cast<char>(first));
  const int wide = claimed < 126 ? 0 : claimed < 65536 ? 2 : 8;
  bytes += static_cast<char>(0x80U | (wide == 0 ? claimed : wide == 2 ? 126U : 127U));
  for (int i = wide - 1; i >= 0; --i) bytes += static_cast<char>(claimed >> (8 * i));
  bytes += mask;
  for (std::size_t i = 0; i < payload.size(); ++i) bytes += static_cast<char>(payload[i] ^ mask[i % 4]);
  return bytes;
}
std::string masked(unsigned first, const std::string& payload) {
  return masked(first, payload, payload.size());
}

TEST(WsFrame, ReadsMessagesHoweverTheyAreCutUp) {
  const std::string stream = masked(0x81, "hello") + masked(0x82, std::string(300, 'x')) + masked(0x89, "");
  for (const std::size_t step : {std::size_t{1}, std::size_t{7}, stream.size()}) {
    WsFrameReader reader(1000);
    std::vector<WsMessage> read;
    for (std::size_t at = 0; at < stream.size(); at += step) {
      reader.feed(std::string_view(stream).substr(at, step));
      while (auto message = reader.next()) read.push_back(std::move(*message));
    }
    ASSERT_EQ(read.size(), 3U) << step;
    EXPECT_EQ(read[0].payload, "hello");
    EXPECT_EQ(read[0].opcode, WsOpcode::kText);
    EXPECT_EQ(read[1].payload, std::string(300, 'x'));
    EXPECT_EQ(read[2].opcode, WsOpcode::kPing);
    EXPECT_FALSE(reader.fault());
  }
}

struct Fault {
  const char* what;
  std::string bytes;
  std::uint16_t code;
};

TEST(WsFrame, RefusesWhatIsNoWholeMessage) {
  const std::vector<Fault> faults = {
      {"a first fragment", masked(0x01, "a"), 1003},
      {"a continuation", masked(0x80, "a"), 1003},
      {"compressed", masked(0xc1, "a"), 1002},
      {"an unknown kind", masked(0x83, "a"), 1002},
      {"not masked", std::string("\x81\x01") + "a", 1002},
      {"a long ping", masked(0x89, std::string(126, 'a')), 1002},
      {"too long", masked(0x82, std::string(101, 'a')), 1009},
      {"so long that only the head is there", masked(0x82, "", 1ULL << 62), 1009},
      {"longer than there are bytes in the world", masked(0x82, "", ~0ULL), 1009},
  };
  for (const Fault& fault : faults) {
    WsFrameReader reader(100);
    reader.feed(fault.bytes);
    EXPECT_FALSE(reader.next()) << fault.what;
    ASSERT_TRUE(reader.fault()) << fault.what;
    EXPECT_EQ(reader.fault()->code, fault.code) << fault.what;
    reader.feed(masked(0x81, "after it"));
    EXPECT_FALSE(reader.next()) << fault.what;
  }
}

TEST(WsFrame, WritesEachLengthAsTheRfcSays) {
  EXPECT_EQ(ws_frame(WsOpcode::kText, "hi"), std::string("\x81\x02hi"));
  EXPECT_EQ(ws_frame(WsOpcode::kBinary, std::string(126, 'a')).substr(0, 4),
            std::string("\x82\x7e\x00\x7e", 4));
  EXPECT_EQ(ws_frame(WsOpcode::kBinary, std::string(65536, 'a')).substr(0, 10),
            std::string("\x82\x7f\x00\x00\x00\x00\x00\x01\x00\x00", 10));
  EXPECT_EQ(ws_close_frame({1001, "end"}), std::string("\x88\x05\x03\xe9") + "end");
  EXPECT_EQ(ws_close_frame({1001, std::string(500, 'e')}).size(), 127U);
}

}  // namespace
}  // namespace dynslam
