// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "base/angles.h"
#include "drivers/rplidar/packet_stream.h"
#include "drivers/rplidar/turn_builder.h"
#include "tests/drivers/rplidar_encoder.h"

namespace dynslam::rplidar {
namespace {

using std::chrono::milliseconds;
using test::PacketBytes;

constexpr double kTurnsPerS = 10.0;
constexpr Duration kDelay = milliseconds(1);

/// A room without walls at right angles: farther and farther clockwise.
double mm_at(double angle_deg) { return 1000.0 + 5.0 * (angle_deg - 360.0 * std::floor(angle_deg / 360.0)); }

struct SentPacket {
  Time came_at;  ///< its last byte
  PacketBytes bytes;
};

struct Kind {
  AnswerType type;
  double sample_us;
  int baud;

  StreamForm form() const { return {find_form(type), from_seconds(1e-6 * sample_us), baud, kDelay}; }
};

void PrintTo(const Kind& kind, std::ostream* out) { *out << std::hex << static_cast<int>(kind.type); }

/// What a lidar that turns evenly, passing 0 at time 0, sends from `begin_s` on.
std::vector<SentPacket> sent(const Kind& kind, double begin_s, double seconds) {
  const PacketForm& form = *find_form(kind.type);
  const double sample_s = 1e-6 * kind.sample_us, step_deg = 360.0 * kTurnsPerS * sample_s;
  const auto n = static_cast<int>(form.samples);
  std::vector<SentPacket> packets;
  for (double t = begin_s; t < begin_s + seconds; t += n * sample_s) {
    std::vector<double> mm, back, angle;
    std::size_t first = form.samples;
    for (int k = 0; k <= n; ++k) {
      const double turned = 360.0 * kTurnsPerS * t + step_deg * k;
      double behind = 0.0;
      if (kind.type == AnswerType::kUltra || kind.type == AnswerType::kExpress ||
          kind.type == AnswerType::kStandard) {
        for (int i = 0; i < 6; ++i) behind = test::triangulation_deg(mm_at(turned - behind));
      }
      if (kind.type == AnswerType::kExpress) behind = std::round(8.0 * behind) / 8.0;
      mm.push_back(mm_at(turned - behind));
      back.push_back(behind);
      angle.push_back(std::fmod(turned - behind + 360.0, 360.0));
      if (std::floor((turned - step_deg) / 360.0) < std::floor(turned / 360.0) && k < n)
        first = static_cast<std::size_t>(k);
    }
    const double start = std::fmod(360.0 * kTurnsPerS * t, 360.0);
    const bool anew = t == begin_s;
    PacketBytes bytes;
    switch (kind.type) {
      case AnswerType::kStandard:
        bytes = test::encode_standard(first == 0, angle[0], mm[0]);
        break;
      case AnswerType::kExpress:
        bytes = test::encode_express(start, anew, mm, back);
        break;
      case AnswerType::kUltra:
        bytes = test::encode_ultra(start, anew, mm);
        break;
      case AnswerType::kDense:
        bytes = test::encode_dense(start, anew, mm);
        break;
      case AnswerType::kUltraDense:
        bytes = test::encode_ultra_dense(start, anew, mm);
        break;
      default:
        bytes = test::encode_hq(angle, mm, first);
    }
    const double came_s = t + (n - 1) * sample_s + 1.5 * sample_s + 10.0 * double(form.size) / kind.baud;
    packets.push_back({time_at_s(came_s) + kDelay, bytes});
  }
  return packets;
}

PacketBytes joined(const std::vector<SentPacket>& packets) {
  PacketBytes all;
  for (const SentPacket& p : packets) all.insert(all.end(), p.bytes.begin(), p.bytes.end());
  return all;
}

std::vector<Sample> fed(const Kind& kind, const std::vector<SentPacket>& packets) {
  PacketStream stream(kind.form());
  std::vector<Sample> samples;
  for (const SentPacket& p : packets) stream.feed(p.bytes, p.came_at, samples);
  return samples;
}

std::vector<Scan> turns_of(const std::vector<Sample>& samples) {
  TurnBuilder builder{LidarMount{}};
  std::vector<Scan> turns;
  for (const Sample& sample : samples) {
    if (auto turn = builder.add(sample)) turns.push_back(std::move(*turn));
  }
  return turns;
}

/// Whether a beam may have come from the room: with a range that is right for its angle.
bool is_true(double angle_deg, double range_m) {
  const double into_turn = angle_deg - 360.0 * std::floor(angle_deg / 360.0);
  if (std::isinf(range_m) || into_turn < 2.0 || into_turn > 358.0) return true;
  return std::abs(1000.0 * range_m - mm_at(angle_deg)) < 8.0;
}

class RplidarStream : public testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(
    All, RplidarStream,
    testing::Values(Kind{AnswerType::kStandard, 252, 256000}, Kind{AnswerType::kExpress, 126, 256000},
                    Kind{AnswerType::kHq, 108.7, 1000000}, Kind{AnswerType::kUltra, 62.90234375, 256000},
                    Kind{AnswerType::kDense, 31, 1000000}, Kind{AnswerType::kUltraDense, 100, 460800}));

TEST_P(RplidarStream, GivesEachBeamItsTimeAngleAndRange) {
  const auto samples = fed(GetParam(), sent(GetParam(), 0.03, 0.5));
  ASSERT_GT(samples.size(), 0.35e6 / GetParam().sample_us);
  for (const Sample& s : samples) {
    // Where the lidar stood when the beam was taken; of nodes it is not known, but within 9 degrees.
    const double stood_deg = 360.0 * kTurnsPerS * seconds_of(s.time);
    const double off = std::remainder(stood_deg - s.turned_deg, 360.0);
    const bool says_where = find_form(GetParam().type)->is_capsule || GetParam().type == AnswerType::kHq;
    ASSERT_NEAR(off, says_where ? 0.0 : 7.5, says_where ? 0.03 : 1.5);
    ASSERT_GT(s.turned_deg, -9.0F);
    ASSERT_LT(s.turned_deg, 360.5F);
    ASSERT_TRUE(is_true(s.angle_deg, s.range_m)) << s.angle_deg << " " << s.range_m;
  }
}

TEST_P(RplidarStream, GivesWholeTurnsCounterClockwiseInTheOrderOfTime) {
  const auto turns = turns_of(fed(GetParam(), sent(GetParam(), 0.03, 0.5)));
  ASSERT_GE(turns.size(), 3U);
  for (const Scan& turn : turns) {
    EXPECT_NEAR(static_cast<double>(turn.beams.size()), 0.1e6 / GetParam().sample_us, 2.0);
    EXPECT_EQ(turn.beams.front().time_s, 0.0F);
    EXPECT_NEAR(turn.beams.back().time_s, 0.1, 0.001);
    EXPECT_NEAR(std::remainder(seconds_of(turn.stamp), 0.1), 0.0, 0.0005);
    EXPECT_NEAR(turn.beams.back().angle_rad - turn.beams.front().angle_rad, -2.0 * kPi, 0.1);
    for (std::size_t i = 1; i < turn.beams.size(); ++i) {
      ASSERT_GE(turn.beams[i].time_s, turn.beams[i - 1].time_s);
      ASSERT_NEAR(turn.beams[i].angle_rad, turn.beams[i - 1].angle_rad, 0.2);
    }
  }
}

TEST_P(RplidarStream, TakesBytesInAnyPieces) {
  const auto packets = sent(GetParam(), 0.03, 0.15);
  const auto whole = fed(GetParam(), packets);
  std::mt19937 random(7);
  PacketStream stream(GetParam().form());
  std::vector<Sample> pieces;
  const PacketBytes all = joined(packets);
  for (std::size_t at = 0; at < all.size();) {
    const std::size_t n = std::min<std::size_t>(1 + random() % 200, all.size() - at);
    stream.feed(ByteView(all).subspan(at, n), packets.back().came_at, pieces);
    at += n;
  }
  ASSERT_EQ(pieces.size(), whole.size());
  for (std::size_t i = 0; i < whole.size(); ++i) {
    ASSERT_EQ(pieces[i].angle_deg, whole[i].angle_deg);
    ASSERT_EQ(pieces[i].range_m, whole[i].range_m);
  }
}

TEST_P(RplidarStream, LosesNoTurnAfterTheOneThatADroppedByteHit) {
  const auto packets = sent(GetParam(), 0.03, 0.5);
  const std::size_t intact = turns_of(fed(GetParam(), packets)).size();
  std::mt19937 random(3);
  for (int round = 0; round < 60; ++round) {
    auto broken = packets;
    PacketBytes& hit = broken[packets.size() / 3 + random() % (packets.size() / 4)].bytes;
    hit.erase(hit.begin() + static_cast<std::ptrdiff_t>(random() % hit.size()));
    const auto samples = fed(GetParam(), broken);
    // Where the packet is the border between turns it hits two.
    ASSERT_GE(turns_of(samples).size() + 2, intact);
    std::size_t wrong = 0;
    for (const Sample& s : samples) wrong += is_true(s.angle_deg, s.range_m) ? 0 : 1;
    ASSERT_LE(wrong, find_form(GetParam().type)->witnesses > 0 ? 2U : 0U) << "nodes have no checksum";
  }
}

TEST_P(RplidarStream, BelievesNoBeamOfAPacketWithAFlippedBit) {
  if (GetParam().type == AnswerType::kStandard) GTEST_SKIP() << "has no checksum";
  const auto packets = sent(GetParam(), 0.03, 0.3);
  const std::size_t intact = fed(GetParam(), packets).size(), in_one = find_form(GetParam().type)->samples;
  for (std::size_t bit = 0; bit < 8 * packets[4].bytes.size(); ++bit) {
    auto broken = packets;
    std::uint8_t& byte = broken[4].bytes[bit / 8];
    byte = static_cast<std::uint8_t>(byte ^ 1 << bit % 8);
    const auto samples = fed(GetParam(), broken);
    ASSERT_GE(samples.size() + 2 * in_one, intact) << bit;
    ASSERT_LT(samples.size(), intact) << bit;
    for (const Sample& s : samples) ASSERT_TRUE(is_true(s.angle_deg, s.range_m)) << bit;
  }
}

TEST_P(RplidarStream, GivesOfAStreamThatIsCutAnywhereOnlyWhatItWouldHaveGiven) {
  const auto packets = sent(GetParam(), 0.03, 0.5);
  const PacketBytes all = joined({packets.begin(), packets.begin() + 4});
  const auto whole = fed(GetParam(), packets);
  for (std::size_t length = 0; length <= all.size(); ++length) {
    PacketStream stream(GetParam().form());
    std::vector<Sample> samples;
    stream.feed(ByteView(all).first(length), Time(), samples);
    ASSERT_LE(samples.size(),
              length * find_form(GetParam().type)->samples / find_form(GetParam().type)->size);
    for (std::size_t i = 0; i < samples.size(); ++i) ASSERT_EQ(samples[i].range_m, whole[i].range_m);
  }
}

TEST_P(RplidarStream, BeginsInMidPacket) {
  auto packets = sent(GetParam(), 0.03, 0.5);
  for (std::size_t cut = 1; cut < packets[0].bytes.size(); ++cut) {
    auto late = packets;
    late[0].bytes.erase(late[0].bytes.begin(), late[0].bytes.begin() + static_cast<std::ptrdiff_t>(cut));
    const auto samples = fed(GetParam(), late);
    for (const Sample& s : samples) ASSERT_TRUE(is_true(s.angle_deg, s.range_m)) << cut;
    ASSERT_GE(turns_of(samples).size(), 3U);
  }
}

TEST_P(RplidarStream, FindsNothingInNoise) {
  if (GetParam().type == AnswerType::kStandard) GTEST_SKIP() << "has no checksum";
  std::mt19937 random(11);
  PacketBytes noise(200000);
  for (std::uint8_t& b : noise) b = static_cast<std::uint8_t>(random());
  PacketStream stream(GetParam().form());
  std::vector<Sample> samples;
  stream.feed(noise, Time(), samples);
  EXPECT_TRUE(samples.empty());
}

TEST_P(RplidarStream, KnowsTheTimeThoughItIsReadLate) {
  std::mt19937 random(5);
  std::exponential_distribution<double> late_s(1.0 / 0.002);
  auto packets = sent(GetParam(), 0.03, 1.0);
  for (SentPacket& p : packets) p.came_at += from_seconds(late_s(random));
  const auto samples = fed(GetParam(), packets);
  double most = 0.0, sum = 0.0;
  std::size_t n = 0;
  for (const Sample& s : samples) {
    if (s.time < time_at_s(0.3)) continue;
    const double off_deg = std::remainder(360.0 * kTurnsPerS * seconds_of(s.time) - s.turned_deg, 360.0);
    const double off_s = off_deg / 360.0 / kTurnsPerS;
    most = std::max(most, std::abs(off_s));
    sum += off_s;
    ++n;
  }
  if (GetParam().type == AnswerType::kStandard) sum -= 0.00208 * static_cast<double>(n);  // 7.5 degrees
  EXPECT_LT(std::abs(sum / static_cast<double>(n)), 0.0008) << "read 2 ms late on average";
  EXPECT_LT(most, 0.004) << "read up to 10 ms late and more";
}

TEST_P(RplidarStream, HandsOutNoTurnThatMissesACapsule) {
  if (!find_form(GetParam().type)->is_capsule) GTEST_SKIP() << "one node more or less is no hole";
  const auto packets = sent(GetParam(), 0.03, 0.5);
  const std::size_t intact = turns_of(fed(GetParam(), packets)).size();
  const double packet_s =
      1e-6 * GetParam().sample_us * static_cast<double>(find_form(GetParam().type)->samples);
  // Half a turn after 0.2 s, where one begins.
  const auto middle = static_cast<std::size_t>((0.25 - 0.03) / packet_s);
  auto flipped = packets, missing = packets;
  flipped[middle].bytes[50] ^= 1;
  missing.erase(missing.begin() + static_cast<std::ptrdiff_t>(middle));
  EXPECT_EQ(turns_of(fed(GetParam(), flipped)).size(), intact - 1);
  EXPECT_EQ(turns_of(fed(GetParam(), missing)).size(), intact - 1);
}

TEST(RplidarUltra, ThrowsTheTurnAwayInWhichTheEncoderWasReset) {
  const Kind ultra{AnswerType::kUltra, 62.90234375, 256000};
  auto packets = sent(ultra, 0.03, 0.5);
  const std::size_t intact = turns_of(fed(ultra, packets)).size();
  auto again = sent(ultra, 0.03, 0.5);
  // The 30th says that the angle is new: bit 15 of the angle, and its place in the sum.
  again[30].bytes[3] ^= 0x80;
  again[30].bytes[1] ^= 0x08;
  EXPECT_EQ(turns_of(fed(ultra, again)).size(), intact - 1);
}

TEST(RplidarUltra, NoticesACapsuleThatIsMissingAltogether) {
  const Kind ultra{AnswerType::kUltra, 62.90234375, 256000};
  auto packets = sent(ultra, 0.03, 0.5);
  packets.erase(packets.begin() + 30);
  PacketStream stream(ultra.form());
  std::vector<Sample> samples;
  for (const SentPacket& p : packets) stream.feed(p.bytes, p.came_at, samples);
  EXPECT_EQ(stream.counts().odd_steps, 1U);
  for (const Sample& s : samples) ASSERT_TRUE(is_true(s.angle_deg, s.range_m));
}

TEST(RplidarStandard, GoesOnThoughTheNodeThatBeginsATurnIsLost) {
  const Kind standard{AnswerType::kStandard, 252, 256000};
  auto packets = sent(standard, 0.03, 0.6);
  const std::size_t intact = turns_of(fed(standard, packets)).size();
  const auto first = std::find_if(packets.begin() + 900, packets.end(),
                                  [](const SentPacket& p) { return (p.bytes[0] & 1) != 0; });
  ASSERT_NE(first, packets.end());
  packets.erase(first);
  EXPECT_EQ(turns_of(fed(standard, packets)).size(), intact);
}

TEST(RplidarTurns, WithAHoleAreNotHandedOut) {
  TurnBuilder builder{LidarMount{}};
  std::vector<std::size_t> sizes;
  for (int i = 180; i < 360 * 5; ++i) {
    const bool in_hole = i > 360 * 2 + 100 && i < 360 * 2 + 130;
    if (in_hole) continue;
    const auto turned = static_cast<float>(i % 360);
    const auto turn = builder.add({Time(milliseconds(i)), turned, turned, 1.0F});
    if (turn) sizes.push_back(turn->beams.size());
  }
  EXPECT_EQ(sizes, (std::vector<std::size_t>{360, 360}));
  EXPECT_EQ(builder.holed(), 1U);
}

TEST(RplidarTurns, LookRight) {
  LidarMount mount{{0.1, 0.0, 0.5}, true, 0.2};
  TurnBuilder builder{mount};
  std::optional<Scan> scan;
  for (int i = 0; i <= 360; ++i) {
    const auto turned = static_cast<float>(i % 360);
    scan = builder.add({Time(milliseconds(1000 + i)), turned, turned - 2.0F, 1.0F});
  }
  ASSERT_TRUE(scan);
  EXPECT_EQ(scan->stamp, Time(milliseconds(1000)));
  EXPECT_NEAR(scan->beams[90].angle_rad, -88.0 * kPi / 180.0, 1e-6);
  EXPECT_NEAR(scan->beams[90].time_s, 0.09, 1e-6);
  EXPECT_TRUE(scan->mount.upside_down);
  EXPECT_EQ(scan->mount.robot_T_lidar, mount.robot_T_lidar);
}

}  // namespace
}  // namespace dynslam::rplidar
