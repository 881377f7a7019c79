// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "drivers/rplidar/packets.h"
#include "tests/drivers/rplidar_encoder.h"

namespace dynslam::rplidar {
namespace {

using Bytes = std::vector<std::uint8_t>;
using test::PacketBytes;

const PacketForm& form(AnswerType type) { return *find_form(type); }

void append(Bytes& bytes, std::initializer_list<int> more) {
  for (const int b : more) bytes.push_back(static_cast<std::uint8_t>(b));
}

/// A pair of capsules that was worked out by hand and with the maker's own decoder.
Bytes worked_ultra() {
  Bytes bytes;
  append(bytes,
         {0xAD, 0x5C, 0x80, 0xD7, 0x90, 0x31, 0xC0, 0xFE, 0xF4, 0x52, 0xC0, 0xFE, 0xEE, 0x03, 0x60, 0xFF,
          0xEE, 0x25, 0x80, 0xFF, 0x71, 0x27, 0x80, 0x01, 0xE2, 0x3D, 0x00, 0x80, 0x00, 0x00, 0xC0, 0xFF});
  for (int i = 0; i < 25; ++i) append(bytes, {0xE8, 0x04, 0, 0});
  return bytes;
}
Bytes worked_ultra_after() {
  Bytes bytes;
  append(bytes, {0xA4, 0x5E, 0xE6, 0x02});
  for (int i = 0; i < 32; ++i) append(bytes, {0xE8, 0x04, 0, 0});
  return bytes;
}

TEST(RplidarPackets, DecodeTheWorkedUltraCapsule) {
  const PacketForm& ultra = form(AnswerType::kUltra);
  const Bytes first = worked_ultra(), second = worked_ultra_after();
  ASSERT_EQ(first.size(), ultra.size);
  ASSERT_TRUE(begins_packet(ultra, first) && is_intact(ultra, first));
  ASSERT_TRUE(begins_packet(ultra, second) && is_intact(ultra, second));
  EXPECT_TRUE(begins_anew(ultra, first));
  EXPECT_FALSE(begins_anew(ultra, second));
  EXPECT_FLOAT_EQ(start_deg(ultra, first), 350.0F);
  EXPECT_NEAR(start_deg(ultra, second), 11.6, 0.01);
  CapsuleBeams beams;
  decode_capsule(ultra, first, second, beams);
  const std::vector<double> mm{400,  403,  990,  1000,  1010,  1490,  1500, 0, 2988, 3000, 3008,
                               4984, 5000, 5016, 20096, 20000, 20048, 0,    0, 2000, 1998};
  const std::vector<double> angle_deg{345.42, 345.64, 343.79, 344.02, 344.24, 344.02, 344.25,
                                      344.08, 344.25, 344.47, 344.70, 344.70, 344.92, 345.15,
                                      345.20, 345.43, 345.66, 346.32, 346.55, 346.94, 347.17};
  for (std::size_t k = 0; k < mm.size(); ++k) {
    EXPECT_EQ(beams[k].range_mm, mm[k]) << k;
    EXPECT_NEAR(350.0 + 0.225 * static_cast<double>(k) - beams[k].back_deg, angle_deg[k], 0.011) << k;
  }
  for (std::size_t k = mm.size(); k < 96; ++k) EXPECT_EQ(beams[k].range_mm, 2000.0F) << k;
}

TEST(RplidarPackets, DecodeTheWorkedNode) {
  const Bytes bytes{0x3D, 0x41, 0x2D, 0x49, 0x13};
  ASSERT_TRUE(begins_packet(form(AnswerType::kStandard), bytes));
  Nodes nodes;
  decode_nodes(form(AnswerType::kStandard), bytes, nodes);
  EXPECT_FLOAT_EQ(nodes[0].angle_deg, 90.5F);
  EXPECT_FLOAT_EQ(nodes[0].range_mm, 1234.25F);
  EXPECT_TRUE(nodes[0].first);
}

TEST(RplidarPackets, DecodeAnExpressCapsuleDoneByHand) {
  // 1000 mm << 2 | 0b10 = 0x0FA2, 16000 mm << 2 | 0b11 = 0xFA03; offsets 0b10'0101 = 37 and 0b11'1111 = 63 in
  // eighths of a degree: low halves 5 and 15, 0xF5. 180 deg * 64 = 0x2D00.
  Bytes bytes{0, 0, 0x00, 0x2D, 0xA2, 0x0F, 0x03, 0xFA, 0xF5};
  bytes.resize(84);
  // 2D ^ A2 ^ 0F ^ 03 ^ FA ^ F5 = 8C
  bytes[0] = 0xAC;
  bytes[1] = 0x58;
  const PacketForm& express = form(AnswerType::kExpress);
  ASSERT_TRUE(begins_packet(express, bytes) && is_intact(express, bytes));
  EXPECT_FLOAT_EQ(start_deg(express, bytes), 180.0F);
  CapsuleBeams beams;
  decode_capsule(express, bytes, bytes, beams);
  EXPECT_FLOAT_EQ(beams[0].range_mm, 1000.0F);
  EXPECT_FLOAT_EQ(beams[0].back_deg, 4.625F);
  EXPECT_FLOAT_EQ(beams[1].range_mm, 16000.0F);
  EXPECT_FLOAT_EQ(beams[1].back_deg, 7.875F);
  EXPECT_EQ(beams[2].range_mm, 0.0F);
}

TEST(RplidarPackets, DecodeTheScalesOfAnUltraDenseCapsule) {
  // Scale 0: 500 * 2 mm, 500 << 2 = 0x007D0. Scale 1: 1000 * 3 + 2046 = 5046 mm, 1000 << 2 | 1 = 0x00FA1.
  // Scale 2: 4000 * 4 + 8187 = 24187 mm, 4000 << 2 | 2 = 0x03E82. Scale 3: 1 * 5 + 24567 mm, 7. How strong
  // the return was, from bit 12 on, is 1 in the first, all ones in the fourth: 0x017D0, 0xF8007.
  Bytes bytes{0, 0, 1, 2, 3, 4, 0, 0, 0x40, 0x0B, 0xD0, 0x17, 0xA1, 0x0F, 0x00, 0x82, 0x3E, 0x07, 0x80, 0xF0};
  bytes.resize(170);
  const PacketForm& dense = form(AnswerType::kUltraDense);
  EXPECT_FLOAT_EQ(start_deg(dense, bytes), 45.0F);
  CapsuleBeams beams;
  decode_capsule(dense, bytes, bytes, beams);
  EXPECT_EQ(beams[0].range_mm, 1000.0F);
  EXPECT_EQ(beams[1].range_mm, 5046.0F);
  EXPECT_EQ(beams[2].range_mm, 24187.0F);
  EXPECT_EQ(beams[3].range_mm, 24572.0F);
  EXPECT_EQ(beams[4].range_mm, 0.0F);
}

TEST(RplidarPackets, DecodeADenseCapsule) {
  Bytes bytes{0, 0, 0, 0x16, 0x10, 0x27};  // 88 deg; 10000 mm
  bytes.resize(84);
  CapsuleBeams beams;
  decode_capsule(form(AnswerType::kDense), bytes, bytes, beams);
  EXPECT_FLOAT_EQ(start_deg(form(AnswerType::kDense), bytes), 88.0F);
  EXPECT_EQ(beams[0].range_mm, 10000.0F);
  EXPECT_EQ(beams[39].range_mm, 0.0F);
}

TEST(RplidarPackets, DecodeAnHqPacket) {
  std::vector<double> angle(96), mm(96);
  for (std::size_t i = 0; i < 96; ++i) {
    angle[i] = 3.5 * static_cast<double>(i);
    mm[i] = 100.25 * static_cast<double>(i);
  }
  const PacketBytes packet = test::encode_hq(angle, mm, 7);
  const PacketForm& hq = form(AnswerType::kHq);
  ASSERT_EQ(packet.size(), hq.size);
  ASSERT_TRUE(begins_packet(hq, packet) && is_intact(hq, packet));
  Nodes nodes;
  decode_nodes(hq, packet, nodes);
  for (std::size_t i = 0; i < 96; ++i) {
    EXPECT_NEAR(nodes[i].angle_deg, angle[i], 0.003);
    EXPECT_FLOAT_EQ(nodes[i].range_mm, static_cast<float>(mm[i]));
    EXPECT_EQ(nodes[i].first, i == 7);
  }
}

TEST(RplidarPackets, ComeOutAsTheyWentIn) {
  std::mt19937 random(1);
  for (int round = 0; round < 50; ++round) {
    // Neighbours on one surface, now and then nothing: what predictions can say.
    std::vector<double> mm;
    double here = 300.0 + static_cast<double>(random() % 10000);
    for (int i = 0; i < 97; ++i) {
      here = std::clamp(here + static_cast<int>(random() % 200) - 100, 200.0, 12000.0);
      mm.push_back(random() % 10 == 0 ? 0.0 : std::round(here));
    }
    CapsuleBeams beams;
    const PacketForm& ultra = form(AnswerType::kUltra);
    const PacketBytes packet = test::encode_ultra(123.5, false, mm);
    const PacketBytes next = test::encode_ultra(145.0, false, std::vector<double>(97, mm[96]));
    ASSERT_TRUE(is_intact(ultra, packet));
    decode_capsule(ultra, packet, next, beams);
    for (std::size_t k = 0; k < 96; ++k) {
      const bool has_neighbour = k % 3 != 2 || mm[k + 1] > 0.0;
      if (beams[k].range_mm == 0.0F && (mm[k] == 0.0 || !has_neighbour || k % 3 == 1)) continue;
      EXPECT_NEAR(beams[k].range_mm, mm[k], 0.002 * mm[k] + 2.0) << k;
      EXPECT_NEAR(beams[k].back_deg, test::triangulation_deg(mm[k]), 0.06) << k;
    }
    const PacketForm& wide = form(AnswerType::kUltraDense);
    const PacketBytes dense = test::encode_ultra_dense(1.0, false, mm);
    ASSERT_EQ(dense.size(), wide.size);
    ASSERT_TRUE(is_intact(wide, dense));
    decode_capsule(wide, dense, dense, beams);
    for (std::size_t k = 0; k < 64; ++k) EXPECT_NEAR(beams[k].range_mm, mm[k], 4.0) << k;
  }
}

TEST(RplidarPackets, WithAFlippedBitAreNotIntact) {
  std::vector<double> mm(97), angle(96, 12.0), back(32, 3.0);
  for (std::size_t i = 0; i < mm.size(); ++i) mm[i] = 1000.0 + 3.0 * static_cast<double>(i);
  const std::vector<std::pair<AnswerType, PacketBytes>> packets{
      {AnswerType::kUltra, test::encode_ultra(10.0, false, mm)},
      {AnswerType::kExpress, test::encode_express(10.0, false, mm, back)},
      {AnswerType::kDense, test::encode_dense(10.0, false, mm)},
      {AnswerType::kUltraDense, test::encode_ultra_dense(10.0, false, mm)},
      {AnswerType::kHq, test::encode_hq(angle, mm, 96)}};
  for (const auto& [type, packet] : packets) {
    ASSERT_EQ(packet.size(), form(type).size);
    ASSERT_TRUE(begins_packet(form(type), packet) && is_intact(form(type), packet));
    for (std::size_t bit = 0; bit < 8 * packet.size(); ++bit) {
      PacketBytes flipped = packet;
      flipped[bit / 8] = static_cast<std::uint8_t>(flipped[bit / 8] ^ 1 << bit % 8);
      EXPECT_FALSE(begins_packet(form(type), flipped) && is_intact(form(type), flipped)) << bit;
    }
  }
}

}  // namespace
}  // namespace dynslam::rplidar
