// SPDX-License-Identifier: MIT
#include "tests/drivers/rplidar_encoder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace dynslam::test {
namespace {

void put(PacketBytes& bytes, std::uint64_t value, int size) {
  for (int i = 0; i < size; ++i) bytes.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

std::uint64_t whole(double v) { return static_cast<std::uint64_t>(std::llround(v)); }

std::uint64_t start_word(double deg, bool anew) {
  return whole(deg * 64.0) % (360 * 64) | (anew ? 0x8000U : 0U);
}

/// Writes the sum of all behind them into the low halves of the first two bytes.
PacketBytes sealed(PacketBytes bytes) {
  std::uint8_t sum = 0;
  for (std::size_t i = 2; i < bytes.size(); ++i) sum = static_cast<std::uint8_t>(sum ^ bytes[i]);
  bytes[0] = static_cast<std::uint8_t>(0xA0 | (sum & 0xF));
  bytes[1] = static_cast<std::uint8_t>(0x50 | sum >> 4);
  return bytes;
}

/// The ultra capsule's scale: ranges of values, where they begin in mm, and how coarse they are.
struct Step {
  int value, mm, shift;
};
constexpr std::array<Step, 6> kScale{
    {{0, 0, 0}, {512, 512, 1}, {1280, 2048, 2}, {1792, 4096, 3}, {3328, 16384, 4}, {4096, 28672, 0}}};

const Step& step_of(int mm) {
  std::size_t i = 0;
  while (i + 2 < kScale.size() && mm >= kScale[i + 1].mm) ++i;
  return kScale[i];
}

int scaled(double mm) {
  const int whole_mm = std::min(static_cast<int>(std::lround(mm)), 28656);
  const Step& step = step_of(whole_mm);
  return step.value + ((whole_mm - step.mm) >> step.shift);
}

std::pair<int, int> mm_and_shift(int value) {
  std::size_t i = 0;
  while (value >= kScale[i + 1].value) ++i;
  return {kScale[i].mm + ((value - kScale[i].value) << kScale[i].shift), kScale[i].shift};
}

/// What a beam differs by from the one it is predicted by.
std::uint32_t prediction(double mm, int from) {
  constexpr int kNothing = -512;
  const auto [base, shift] = mm_and_shift(from);
  const auto difference = static_cast<int>(std::floor((std::round(mm) - base) / std::exp2(shift)));
  const bool can = mm > 0.0 && from > 0 && difference > kNothing && difference < 511;
  return static_cast<std::uint32_t>(can ? difference : kNothing) & 0x3FF;
}

std::uint32_t ultra_dense_word(double mm) {
  const std::uint64_t v = whole(mm);
  const std::uint64_t quality = mm > 0.0 ? 1 : 0;
  std::uint64_t word = 0;
  if (v < 2046) {
    word = v / 2 << 2 | quality << 12;
  } else if (v < 8187) {
    word = 1 | (v - 2046) / 3 << 2 | quality << 13;
  } else if (v < 24567) {
    word = 2 | (v - 8187) / 4 << 2 | quality << 14;
  } else {
    word = 3 | (v - 24567) / 5 << 2 | quality << 15;
  }
  return static_cast<std::uint32_t>(word);
}

/// CRC-32 as zlib and Ethernet have it, bit by bit.
std::uint32_t crc32(std::span<const std::uint8_t> bytes) {
  std::uint32_t crc = 0xFFFFFFFF;
  for (const std::uint8_t byte : bytes) {
    crc ^= byte;
    for (int i = 0; i < 8; ++i) crc = crc >> 1 ^ ((crc & 1) != 0 ? 0xEDB88320 : 0);
  }
  return ~crc;
}

}  // namespace

double triangulation_deg(double mm) {
  if (mm < 50.0) return 7.5;
  const double k = 98361.0 / (4.0 * mm);
  return 8.0 - (64.0 * k + k * k * k / 98304.0) / 65536.0 * 180.0 / 3.14159265358979;
}

PacketBytes encode_standard(bool first, double angle_deg, double mm) {
  const std::uint64_t quality = mm > 0.0 ? 15 : 0;
  PacketBytes bytes;
  put(bytes, quality << 2 | (first ? 1 : 2), 1);
  put(bytes, whole(angle_deg * 64.0) << 1 | 1, 2);
  put(bytes, whole(mm * 4.0), 2);
  return bytes;
}

PacketBytes encode_express(double start_deg, bool anew, std::span<const double> mm,
                           std::span<const double> back_deg) {
  PacketBytes bytes(2);
  put(bytes, start_word(start_deg, anew), 2);
  for (std::size_t i = 0; i < 32; i += 2) {
    const std::uint64_t a = whole(back_deg[i] * 8.0), b = whole(back_deg[i + 1] * 8.0);
    put(bytes, whole(mm[i]) << 2 | a >> 4, 2);
    put(bytes, whole(mm[i + 1]) << 2 | b >> 4, 2);
    put(bytes, (a & 0xF) | (b & 0xF) << 4, 1);
  }
  return sealed(bytes);
}

PacketBytes encode_ultra(double start_deg, bool anew, std::span<const double> mm) {
  PacketBytes bytes(2);
  put(bytes, start_word(start_deg, anew), 2);
  for (std::size_t i = 0; i < 96; i += 3) {
    const int here = scaled(mm[i]), after = scaled(mm[i + 3]);
    const std::uint32_t first = prediction(mm[i + 1], here > 0 ? here : after);
    const std::uint32_t second = prediction(mm[i + 2], after);
    put(bytes, static_cast<std::uint32_t>(here) | first << 12 | second << 22, 4);
  }
  return sealed(bytes);
}

PacketBytes encode_dense(double start_deg, bool anew, std::span<const double> mm) {
  PacketBytes bytes(2);
  put(bytes, start_word(start_deg, anew), 2);
  for (std::size_t i = 0; i < 40; ++i) put(bytes, whole(mm[i]), 2);
  return sealed(bytes);
}

PacketBytes encode_ultra_dense(double start_deg, bool anew, std::span<const double> mm) {
  PacketBytes bytes(2);
  put(bytes, 0x01020304, 4);  // the device's time
  put(bytes, 0, 2);           // its state
  put(bytes, start_word(start_deg, anew), 2);
  for (std::size_t i = 0; i < 64; i += 2) {
    const std::uint32_t a = ultra_dense_word(mm[i]), b = ultra_dense_word(mm[i + 1]);
    put(bytes, a & 0xFFFF, 2);
    put(bytes, b & 0xFFFF, 2);
    put(bytes, a >> 16 | b >> 16 << 4, 1);
  }
  return sealed(bytes);
}

PacketBytes encode_hq(std::span<const double> angle_deg, std::span<const double> mm, std::size_t first) {
  PacketBytes bytes{0xA5};
  put(bytes, 0x1122334455667788, 8);  // the device's time
  for (std::size_t i = 0; i < 96; ++i) {
    put(bytes, whole(angle_deg[i] * 16384.0 / 90.0), 2);
    put(bytes, whole(mm[i] * 4.0), 4);
    put(bytes, mm[i] > 0.0 ? 188 : 0, 1);
    put(bytes, i == first ? 1 : 0, 1);
  }
  PacketBytes padded = bytes;
  padded.resize(780);
  put(bytes, crc32(padded), 4);
  return bytes;
}

}  // namespace dynslam::test
