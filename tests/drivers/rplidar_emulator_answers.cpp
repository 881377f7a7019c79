// SPDX-License-Identifier: MIT
// What the emulated lidar says; how it is said stands in rplidar_emulator.cpp.
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/angles.h"
#include "tests/drivers/rplidar_emulator.h"

namespace dynslam::test {
namespace {

using std::chrono::milliseconds;

constexpr Duration kBoot = milliseconds(300);

void put(PacketBytes& bytes, std::uint64_t value, int size) {
  for (int i = 0; i < size; ++i) bytes.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

std::uint32_t u32(const PacketBytes& bytes) {
  return static_cast<std::uint32_t>(bytes[0] | bytes[1] << 8 | bytes[2] << 16) |
         static_cast<std::uint32_t>(bytes[3]) << 24;
}

}  // namespace

void RplidarEmulator::reply(std::uint8_t type, const PacketBytes& payload) {
  PacketBytes bytes{0xA5, 0x5A};
  put(bytes, payload.size(), 4);
  bytes.push_back(type);
  bytes.insert(bytes.end(), payload.begin(), payload.end());
  send(bytes);
}

void RplidarEmulator::set_motor(double turns_per_s) {
  if (turns_per_s_ == 0.0) motor_at_ = clock_.now();
  turns_per_s_ = turns_per_s;
}

void RplidarEmulator::answer(std::uint8_t command, const PacketBytes& payload) {
  const bool spins_by_itself = !kind_.has_accessory_board && kind_.model >> 4 < 6;
  const std::uint8_t family = kind_.model >> 4;
  stream_.reset();
  switch (command) {
    case 0x20:
    case 0x82: {
      if (health_ == 2) return;
      if (spins_by_itself && turns_per_s_ == 0.0) set_motor(10.0);
      if (command == 0x20) {
        const bool hq = !kind_.modes.empty() && kind_.modes[0].answer == kHq;
        begin_stream(kind_.modes.empty() || hq ? EmulatedLidar::Mode{"", 476, 12, kStandard}
                                               : kind_.modes[0]);
      } else if (kind_.modes.empty()) {
        begin_stream({"", 238, 12, kExpress});
      } else if (payload[0] < kind_.modes.size()) {
        begin_stream(kind_.modes[payload[0]]);
      }
      return;
    }
    case 0x40:
      ++resets_;
      if (!lasting_) health_ = 0;
      awake_at_ = clock_.now() + kBoot;
      greet_at_ = awake_at_;
      return;
    case 0x50: {
      PacketBytes info{kind_.model, static_cast<std::uint8_t>(kind_.firmware),
                       static_cast<std::uint8_t>(kind_.firmware >> 8), kind_.hardware};
      for (std::uint8_t i = 0; i < 16; ++i) info.push_back(static_cast<std::uint8_t>(0xC0 + i));
      return reply(0x04, info);
    }
    case 0x52:
      return reply(0x06, {health_, static_cast<std::uint8_t>(health_ == 2 ? 0x02 : 0),
                          static_cast<std::uint8_t>(health_ == 2 ? 0x80 : 0)});
    case 0x59:
      return reply(0x15, {0xDC, 0x01, 0xEE, 0x00});  // 476 and 238 us
    case 0x84:
      return kind_.modes.empty() ? void() : answer_conf(payload);
    case 0xA8:
      return family >= 6 ? set_motor((payload[0] | payload[1] << 8) / 60.0) : void();
    case 0xF0:
      return kind_.has_accessory_board ? set_motor((payload[0] | payload[1] << 8) / 66.0) : void();
    case 0xFF:
      return reply(0xFF, {static_cast<std::uint8_t>(kind_.has_accessory_board ? 1 : 0), 0, 0, 0});
    default:
      return;
  }
}

void RplidarEmulator::answer_conf(const PacketBytes& payload) {
  PacketBytes data(payload.begin(), payload.begin() + 4);
  const std::uint32_t item = u32(payload);
  const std::size_t id = payload.size() >= 6 ? payload[4] : 0;
  if (id >= kind_.modes.size()) return;
  const EmulatedLidar::Mode& mode = kind_.modes[id];
  switch (item) {
    case 0x70:
      put(data, kind_.modes.size(), 2);
      break;
    case 0x7C:
      put(data, kind_.typical, 2);
      break;
    case 0x71:
      put(data, static_cast<std::uint64_t>(std::lround(mode.sample_us * 256)), 4);
      break;
    case 0x74:
      put(data, static_cast<std::uint64_t>(std::lround(mode.max_range_m * 256)), 4);
      break;
    case 0x75:
      put(data, mode.answer, 1);
      break;
    case 0x7F:
      data.insert(data.end(), mode.name.begin(), mode.name.end());
      data.push_back(0);
      break;
    default:
      return;
  }
  reply(0x20, data);
}

void RplidarEmulator::begin_stream(const EmulatedLidar::Mode& mode) {
  if (std::exchange(untidy_, false)) {
    // The end of what it measured before, in which there is much that looks like something else.
    PacketBytes rest(50, 0xA5);
    for (const int b : {0xA5, 0x5A, 0x84, 0, 0, 0x40, 0x33, 0xA5, 0x5A, 0xA5})
      rest.push_back(static_cast<std::uint8_t>(b));
    send(rest);
    stream_.emplace(Stream{mode, {}, 0, true});
  } else {
    stream_.emplace(Stream{mode, {}, 0, false});
  }
  PacketBytes head{0xA5, 0x5A};
  put(head, packet_size(mode.answer) | 1U << 30, 4);
  head.push_back(mode.answer);
  send(head);
  stream_->begin = std::max(clock_.now() + milliseconds(2), motor_at_ + spin_up_);
}

double RplidarEmulator::turned_deg(Time t) const { return 360.0 * turns_per_s_ * to_seconds(t - motor_at_); }

double RplidarEmulator::mm_at(double angle_deg, Time t) const {
  const double range_m = ranger_(wrap_angle(radians(-angle_deg)), t);
  return std::isfinite(range_m) ? std::min(1000.0 * range_m, 16000.0) : 0.0;
}

PacketBytes RplidarEmulator::next_packet() {
  const std::uint8_t answer = stream_->mode.answer;
  const bool triangulates = answer == kStandard || answer == kExpress || answer == kUltra;
  const int n = samples_in(answer);
  std::vector<double> mm, back, angle;
  const Time begin = stream_->begin + sample_time() * stream_->samples;
  std::size_t first = static_cast<std::size_t>(n);
  for (int k = 0; k <= n; ++k) {
    const Time t = begin + sample_time() * k;
    const double turned = turned_deg(t);
    double behind = triangulates ? 8.0 : 0.0;
    for (int i = 0; i < 4 && triangulates; ++i) {
      behind = triangulation_deg(mm_at(turned - behind, t));
      // As coarse as it can be said.
      if (answer == kExpress) behind = std::clamp(std::round(8.0 * behind) / 8.0, 0.0, 7.875);
    }
    mm.push_back(mm_at(turned - behind, t));
    back.push_back(behind);
    angle.push_back(std::fmod(turned - behind + 360.0, 360.0));
    const double before = turned_deg(t - sample_time());
    if (std::floor(before / 360.0) != std::floor(turned / 360.0))
      first = std::min(first, static_cast<std::size_t>(k));
  }
  const double start = std::fmod(turned_deg(begin), 360.0);
  const bool anew = stream_->samples == 0;
  stream_->samples += n;
  switch (answer) {
    case kStandard:
      return encode_standard(first == 0, angle[0], mm[0]);
    case kExpress:
      return encode_express(start, anew, mm, back);
    case kUltra:
      return encode_ultra(start, anew, mm);
    case kDense:
      return encode_dense(start, anew, mm);
    case kUltraDense:
      return encode_ultra_dense(start, anew, mm);
    default:
      return encode_hq(angle, mm, first);
  }
}

}  // namespace dynslam::test
