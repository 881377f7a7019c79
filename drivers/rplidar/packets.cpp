// SPDX-License-Identifier: MIT
#include "drivers/rplidar/packets.h"

#include <algorithm>

#include <zlib.h>

#include "base/angles.h"

namespace dynslam::rplidar {
namespace {

constexpr std::array<PacketForm, 6> kForms{{
    {AnswerType::kStandard, 5, 1, false, 4},
    {AnswerType::kExpress, 84, 32, true, 0},
    {AnswerType::kHq, kLargestPacket, 96, false, 0},
    {AnswerType::kUltra, 132, 96, true, 0},
    {AnswerType::kDense, 84, 40, true, 0},
    {AnswerType::kUltraDense, 170, 64, true, 0},
}};

constexpr std::size_t kAngleAt = 2, kUltraDenseAngleAt = 8;
constexpr std::size_t kBodyAt = 4, kUltraDenseBodyAt = 10, kHqBodyAt = 9;
constexpr float kQ6 = 64.0F, kQ2 = 4.0F;

std::size_t angle_at(const PacketForm& form) {
  return form.type == AnswerType::kUltraDense ? kUltraDenseAngleAt : kAngleAt;
}

/// 16 pairs of {distance << 2 | offset's high bits, the same again, both offsets' low bits}, mm and 1/8 deg.
void decode_express(ByteView packet, CapsuleBeams& beams) {
  for (std::size_t i = 0; i < 16; ++i) {
    const ByteView pair = packet.subspan(kBodyAt + 5 * i, 5);
    for (const std::size_t side : {0U, 1U}) {
      const std::uint16_t word = u16_at(pair, 2 * side);
      const int low = side == 0 ? pair[4] & 0xF : pair[4] >> 4;
      const int offset = (word & 3) << 4 | low;
      beams[2 * i + side] = {static_cast<float>(word >> 2), static_cast<float>(offset) / 8.0F};
    }
  }
}

void decode_dense(ByteView packet, CapsuleBeams& beams) {
  for (std::size_t i = 0; i < 40; ++i) beams[i] = {static_cast<float>(u16_at(packet, kBodyAt + 2 * i)), 0.0F};
}

/// 20 bits: a scale in the low two, then a value as long as the scale says, then how strong the return was.
float ultra_dense_mm(std::uint32_t bits) {
  constexpr std::array<int, 4> kStep{2, 3, 4, 5}, kBase{0, 2046, 8187, 24567};
  const std::uint32_t scale = bits & 3;
  const auto value = static_cast<int>(bits >> 2 & ((1U << (10 + scale)) - 1));
  return static_cast<float>(value * kStep[scale] + kBase[scale]);
}

void decode_ultra_dense(ByteView packet, CapsuleBeams& beams) {
  for (std::size_t i = 0; i < 32; ++i) {
    const ByteView pair = packet.subspan(kUltraDenseBodyAt + 5 * i, 5);
    const std::uint32_t high = pair[4];
    beams[2 * i] = {ultra_dense_mm(u16_at(pair, 0) | (high & 0xF) << 16), 0.0F};
    beams[2 * i + 1] = {ultra_dense_mm(u16_at(pair, 2) | (high >> 4) << 16), 0.0F};
  }
}

/// A distance on the scale of ultra capsules, which is the coarser the farther.
struct Scaled {
  int mm = 0;
  int level = 0;  ///< predictions that start from it are shifted by so many bits
};

Scaled scaled(std::uint32_t v) {
  const auto value = static_cast<int>(v);
  if (value < 512) return {value, 0};
  if (value < 1280) return {512 + (value - 512) * 2, 1};
  if (value < 1792) return {2048 + (value - 1280) * 4, 2};
  if (value < 3328) return {4096 + (value - 1792) * 8, 3};
  return {16384 + (value - 3328) * 16, 4};
}

constexpr int kNoReturnLow = -512, kNoReturnHigh = 511;

/// How a triangulating lidar's beam lies askew: its own tilt, less what the distance between laser and lens
/// makes out.
float triangulation_deg(int mm) {
  constexpr int kNear_mm = 50;
  constexpr float kNear_deg = 7.5F, kTilt_deg = 8.0F;
  if (mm < kNear_mm) return kNear_deg;
  const auto k = static_cast<float>(98361 / (4 * mm));
  const float parallax_rad = (64.0F * k + k * k * k / 98304.0F) / 65536.0F;
  return kTilt_deg - static_cast<float>(degrees(1.0)) * parallax_rad;
}

CapsuleBeam ultra_beam(int mm) { return {static_cast<float>(std::max(0, mm)), triangulation_deg(mm)}; }

CapsuleBeam predicted(const Scaled& from, int prediction) {
  if (prediction == kNoReturnLow || prediction == kNoReturnHigh) return ultra_beam(0);
  return ultra_beam(from.mm + prediction * (1 << from.level));
}

/// 32 words: every third beam's distance in 12 bits, and what the two behind it differ by from it and from
/// the next, in 10 bits each.
void decode_ultra(ByteView packet, ByteView next, CapsuleBeams& beams) {
  for (std::size_t i = 0; i < 32; ++i) {
    const std::uint32_t word = u32_at(packet, kBodyAt + 4 * i);
    const std::uint32_t word_after = i < 31 ? u32_at(packet, kBodyAt + 4 * (i + 1)) : u32_at(next, kBodyAt);
    const Scaled here = scaled(word & 0xFFF), after = scaled(word_after & 0xFFF);
    const int first = static_cast<std::int32_t>(word << 10) >> 22,
              second = static_cast<std::int32_t>(word) >> 22;
    beams[3 * i] = ultra_beam(here.mm);
    beams[3 * i + 1] = predicted(here.mm == 0 ? after : here, first);
    beams[3 * i + 2] = predicted(after, second);
  }
}

std::uint32_t hq_checksum(ByteView packet) {
  // Padded with zeros to a multiple of four bytes.
  constexpr std::size_t kSummed = kLargestPacket - 4;
  constexpr std::array<std::uint8_t, 3> kPadding{};
  const uLong sum = crc32(crc32(0, nullptr, 0), packet.data(), kSummed);
  return static_cast<std::uint32_t>(crc32(sum, kPadding.data(), kPadding.size()));
}

}  // namespace

const PacketForm* find_form(AnswerType type) {
  const auto it =
      std::find_if(kForms.begin(), kForms.end(), [&](const PacketForm& f) { return f.type == type; });
  return it == kForms.end() ? nullptr : &*it;
}

bool begins_packet(const PacketForm& form, ByteView bytes) {
  if (form.type == AnswerType::kHq) return bytes[0] == 0xA5;
  if (form.is_capsule) return bytes[0] >> 4 == 0xA && bytes[1] >> 4 == 0x5;
  const bool first = (bytes[0] & 1) != 0, not_first = (bytes[0] & 2) != 0;
  return first != not_first && (bytes[1] & 1) != 0;
}

bool is_intact(const PacketForm& form, ByteView packet) {
  if (form.type == AnswerType::kHq) return hq_checksum(packet) == u32_at(packet, kLargestPacket - 4);
  if (!form.is_capsule) return true;
  return xor_of(packet.subspan(2, form.size - 2)) == ((packet[0] & 0xF) | (packet[1] & 0xF) << 4);
}

float start_deg(const PacketForm& form, ByteView packet) {
  return static_cast<float>(u16_at(packet, angle_at(form)) & 0x7FFF) / kQ6;
}

bool begins_anew(const PacketForm& form, ByteView packet) {
  return (u16_at(packet, angle_at(form)) & 0x8000) != 0;
}

void decode_capsule(const PacketForm& form, ByteView packet, ByteView next, CapsuleBeams& beams) {
  if (form.type == AnswerType::kUltra) return decode_ultra(packet, next, beams);
  if (form.type == AnswerType::kUltraDense) return decode_ultra_dense(packet, beams);
  if (form.type == AnswerType::kDense) return decode_dense(packet, beams);
  decode_express(packet, beams);
}

void decode_nodes(const PacketForm& form, ByteView packet, Nodes& nodes) {
  if (form.type == AnswerType::kStandard) {
    nodes[0] = {static_cast<float>(u16_at(packet, 1) >> 1) / kQ6, static_cast<float>(u16_at(packet, 3)) / kQ2,
                (packet[0] & 1) != 0};
    return;
  }
  for (std::size_t i = 0; i < form.samples; ++i) {
    const ByteView node = packet.subspan(kHqBodyAt + 8 * i, 8);
    nodes[i] = {static_cast<float>(u16_at(node, 0)) * (90.0F / 16384.0F),
                static_cast<float>(u32_at(node, 2)) / kQ2, (node[7] & 1) != 0};
  }
}

}  // namespace dynslam::rplidar
