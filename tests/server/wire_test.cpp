// SPDX-License-Identifier: MIT
// The messages of web/wire.md against the files that the page's tests read too. DYNSLAM_GOLDEN=write writes
// the binary ones anew.
#include <cstdlib>
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <zlib.h>

#include "server/control_message.h"
#include "server/map_message.h"
#include "server/video_message.h"
#include "server/wire_bytes.h"

namespace dynslam {
namespace {

std::string golden_path(const std::string& name) {
  return std::string(DYNSLAM_SOURCE_DIR) + "/web/golden/" + name;
}
std::string golden(const std::string& name) {
  std::ifstream file(golden_path(name), std::ios::binary);
  EXPECT_TRUE(file) << name;
  return {std::istreambuf_iterator<char>(file), {}};
}
void check_golden(const std::string& name, const std::string& bytes) {
  const char* write = std::getenv("DYNSLAM_GOLDEN");
  if (write && std::string(write) == "write") std::ofstream(golden_path(name), std::ios::binary) << bytes;
  EXPECT_TRUE(golden(name) == bytes) << name;
}

std::string inflated(std::string_view packed, std::size_t size) {
  std::string raw(size, '\0');
  uLongf got = raw.size();
  const int failed = uncompress(reinterpret_cast<Bytef*>(raw.data()), &got,
                                reinterpret_cast<const Bytef*>(packed.data()), packed.size());
  EXPECT_EQ(failed, Z_OK);
  raw.resize(got);
  return raw;
}

/// Two chunks with a wall, some floor and much that is unknown.
std::vector<CodedChunk> drawn_chunks() {
  std::vector<CodedChunk> chunks;
  for (const ChunkIndex index : {ChunkIndex{0, 0}, ChunkIndex{-3, 250}}) {
    Chunk chunk;
    for (int x = 0; x < 64; ++x) chunk.hit[5][x] = static_cast<std::uint8_t>(52 + 3 * x);
    for (int x = 10; x < 20; ++x) chunk.miss[6][x] = static_cast<std::uint8_t>(25 * (x - 9));
    chunks.push_back({index, 7, time_at_s(12.5), code_cells(chunk)});
  }
  return chunks;
}

TEST(Wire, CodesWhatTheCellRulesSay) {
  const CodedCells cells = drawn_chunks()[0].cells;
  EXPECT_EQ(cells[0], 0);
  EXPECT_EQ(cells[5 * 64], 2 << 6 | 52 >> 5);
  EXPECT_EQ(cells[5 * 64 + 63], 2 << 6 | 7);
  EXPECT_EQ(cells[6 * 64 + 10], 1 << 6 | 0);
  EXPECT_EQ(cells[6 * 64 + 19], 1 << 6 | 7);
}

TEST(Wire, MapMessageIsTheGoldenOne) {
  const auto chunks = drawn_chunks();
  const std::string bytes = to_bytes({0x1122334455667788, time_at_s(99.25), 0.02F, true}, chunks);
  const std::string raw = inflated(std::string_view(bytes).substr(24), 2 * 4112);
  ASSERT_EQ(raw.size(), 2U * 4112U);
  EXPECT_EQ(read_le<std::int16_t>(raw, 4112), -3);
  EXPECT_EQ(read_le<std::int16_t>(raw, 4114), 250);
  // Another zlib may pack in another way: what is inside counts.
  const char* write = std::getenv("DYNSLAM_GOLDEN");
  if (write && std::string(write) == "write") check_golden("map.bin", bytes);
  const std::string kept = golden("map.bin");
  EXPECT_EQ(kept.substr(0, 24), bytes.substr(0, 24));
  EXPECT_EQ(inflated(std::string_view(kept).substr(24), 2 * 4112), raw);
}

TEST(Wire, MapWithoutChunksIsAWholeMessage) {
  const std::string bytes = to_bytes({1, Time(), 0.05F, true}, {});
  EXPECT_EQ(read_le<std::uint16_t>(bytes, 2), 0);
  EXPECT_EQ(inflated(std::string_view(bytes).substr(24), 10), "");
}

std::string have_bytes(std::uint32_t kind, std::uint32_t count, std::uint64_t map_id) {
  std::string bytes;
  append_le(bytes, kind);
  append_le(bytes, count);
  append_le(bytes, map_id);
  return bytes;
}

TEST(Wire, WhatAClientHasIsTheGoldenOne) {
  std::string bytes = have_bytes(1, 2, 0x1122334455667788);
  for (const auto& [x, y, version] : {std::tuple{0, 0, 7U}, std::tuple{-3, 250, 6U}}) {
    append_le(bytes, static_cast<std::int16_t>(x));
    append_le(bytes, static_cast<std::int16_t>(y));
    append_le(bytes, version);
  }
  check_golden("map_have.bin", bytes);
  const auto have = parse_map_have(golden("map_have.bin"));
  ASSERT_TRUE(have);
  EXPECT_EQ(have->map_id, 0x1122334455667788U);
  EXPECT_EQ(have->chunks, (ChunkVersions{{{0, 0}, 7}, {{-3, 250}, 6}}));
}

TEST(Wire, RefusesWhatIsNoListOfChunks) {
  EXPECT_TRUE(parse_map_have(have_bytes(1, 0, 0)));
  EXPECT_FALSE(parse_map_have(""));
  EXPECT_FALSE(parse_map_have(have_bytes(1, 0, 0).substr(1)));
  EXPECT_FALSE(parse_map_have(have_bytes(2, 0, 0)));
  EXPECT_FALSE(parse_map_have(have_bytes(1, 1, 0)));
  EXPECT_FALSE(parse_map_have(have_bytes(1, 0xffffffff, 0)));
  EXPECT_FALSE(parse_map_have(have_bytes(1, 1, 0) + "1234567"));
  EXPECT_FALSE(parse_map_have(have_bytes(1, 40000, 0) + std::string(8 * 40000, '\0')));
}

TEST(Wire, VideoMessageIsTheGoldenOne) {
  const JpegFrame frame{time_at_s(4.5), {0xff, 0xd8, 0xff, 0xd9}};
  check_golden("video.bin", to_bytes(frame, 3));
}

TEST(Wire, TakesAcknowledgementsOfPicturesAndNothingElse) {
  EXPECT_EQ(parse_video_ack(R"({"ack":3})"), 3U);
  for (const char* text : {"", "3", "{}", R"({"ack":-1})", R"({"ack":1.5})", R"({"ack":4294967296})",
                           R"({"ack":"3"})", R"({"ack":3,"more":1})", R"({"ack":3)"})
    EXPECT_FALSE(parse_video_ack(text)) << text;
  EXPECT_FALSE(parse_video_ack(R"({"ack":3})" + std::string(100, ' ')));
}

/// In a word what a message means, or why it is refused.
nlohmann::json meaning(const ControlMessage& message) {
  if (const auto* drive = std::get_if<DriveWish>(&message))
    return {{"seq", drive->seq}, {"v", drive->twist.v_mps}, {"w", drive->twist.w_radps}};
  if (const auto* lease = std::get_if<LeaseWish>(&message)) {
    constexpr const char* kNames[] = {"acquire", "release", "take_over"};
    return {{"lease", kNames[static_cast<int>(*lease)]}};
  }
  if (std::holds_alternative<StopWish>(message)) return {{"stop", true}};
  return {{"refused", std::get<BadMessage>(message).why}};
}

TEST(Wire, ControlMessagesMeanWhatTheGoldenFileSays) {
  const auto cases = nlohmann::json::parse(golden("control.json"));
  ASSERT_GT(cases.size(), 20U);
  for (const auto& one : cases) {
    const std::string text = one["text"];
    EXPECT_EQ(meaning(parse_control(text)), one["means"]) << text;
  }
}

TEST(Wire, ControlMessagesOfAnyBytesAreRefusedInWords) {
  EXPECT_TRUE(std::holds_alternative<BadMessage>(parse_control(std::string(2000, '['))));
  EXPECT_TRUE(std::holds_alternative<BadMessage>(parse_control(std::string("\0\xff\xfe{", 4))));
  EXPECT_TRUE(std::holds_alternative<BadMessage>(parse_control(std::string(1000, '['))));
}

}  // namespace
}  // namespace dynslam
