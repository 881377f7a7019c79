// SPDX-License-Identifier: MIT
#include "drivers/rplidar/packet_stream.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dynslam::rplidar {
namespace {

constexpr float kTurn_deg = 360.0F;
constexpr double kMostTurns_per_s = 50.0;
/// A motor does not get so much faster from one capsule to the next: one between them is missing.
constexpr float kMostGain = 1.5F;
/// Beyond this a new turn has begun, though the node that says so got lost.
constexpr float kTurnOver_deg = 365.0F;
/// Nodes lie this far behind the one before at most, as the correction of near things differs.
constexpr float kMostBack_deg = 90.0F;

float range_m(float mm) { return mm > 0.0F ? 0.001F * mm : std::numeric_limits<float>::infinity(); }

}  // namespace

PacketStream::PacketStream(const StreamForm& form) : form_(form), byte_(from_seconds(10.0 / form.baud)) {
  bytes_.reserve(2 * kLargestPacket + 4096);
  kept_.reserve(kLargestPacket);
}

/// A packet whose checksum may have come out right by chance, or that has none, needs others behind it.
std::size_t PacketStream::bytes_needed() const {
  const std::size_t witnesses = std::max<std::size_t>(form_.packet->witnesses, in_step_ ? 0 : 1);
  return form_.packet->size * std::max<std::size_t>(1, witnesses) + (witnesses > 0 ? kPacketHead : 0);
}

bool PacketStream::is_witnessed(ByteView rest) const {
  for (std::size_t at = form_.packet->size; at + kPacketHead <= bytes_needed(); at += form_.packet->size) {
    if (!begins_packet(*form_.packet, rest.subspan(at))) return false;
  }
  return true;
}

void PacketStream::skip_byte() {
  ++counts_.skipped_bytes;
  in_step_ = false;
  drop_kept();
  arrivals_.forget();
}

void PacketStream::drop_kept() {
  gap_ = true;
  kept_.clear();
}

void PacketStream::feed(ByteView bytes, Time read_at, std::vector<Sample>& out) {
  bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  std::size_t at = 0;
  while (at + kPacketHead <= bytes_.size()) {
    const ByteView rest = ByteView(bytes_).subspan(at);
    const bool begins = begins_packet(*form_.packet, rest);
    if (begins && rest.size() < bytes_needed()) break;
    const bool intact = begins && is_intact(*form_.packet, rest);
    if (begins && !intact) ++counts_.bad_checksums;
    if (!intact || !is_witnessed(rest)) {
      skip_byte();
      ++at;
      continue;
    }
    in_step_ = true;
    at += form_.packet->size;
    take(rest.first(form_.packet->size), read_time(at, read_at), out);
  }
  bytes_.erase(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(at));
  read_before_ = bytes_.size();
  before_at_ = read_at;
}

/// When the byte before `end` had come, as far as it was not read later.
Time PacketStream::read_time(std::size_t end, Time read_at) const {
  if (end <= read_before_) return before_at_ - byte_ * static_cast<int>(read_before_ - end);
  return read_at - byte_ * static_cast<int>(bytes_.size() - end);
}

void PacketStream::take(ByteView packet, Time read_at, std::vector<Sample>& out) {
  ++counts_.packets;
  const Time came_at = arrivals_.next(read_at, form_.sample * static_cast<int>(form_.packet->samples));
  if (form_.packet->is_capsule) {
    take_capsule(packet, came_at, out);
  } else {
    take_nodes(packet, came_at, out);
  }
}

/// The light is half a sample under way on average, the device takes one more, then the packet goes out.
Time PacketStream::time_of(std::size_t sample, Time came_at) const {
  const auto later = static_cast<int>(form_.packet->samples - 1 - sample);
  return came_at - form_.delay - byte_ * static_cast<int>(form_.packet->size) - form_.sample * 3 / 2 -
         form_.sample * later;
}

void PacketStream::take_capsule(ByteView packet, Time came_at, std::vector<Sample>& out) {
  if (begins_anew(*form_.packet, packet)) {
    drop_kept();
    anew_ = true;
  }
  if (start_deg(*form_.packet, packet) >= kTurn_deg) {
    ++counts_.odd_steps;
    drop_kept();
    return;
  }
  if (!kept_.empty()) {
    float step = start_deg(*form_.packet, packet) - start_deg(*form_.packet, kept_);
    if (step < 0.0F) step += kTurn_deg;
    const double longest =
        kMostTurns_per_s * kTurn_deg * to_seconds(form_.sample) * static_cast<double>(form_.packet->samples);
    const bool odd = step > longest || (usual_step_deg_ > 0.0F && step > kMostGain * usual_step_deg_);
    if (odd) {
      ++counts_.odd_steps;
      drop_kept();
      arrivals_.forget();
    } else {
      emit_kept(packet, step, out);
    }
    usual_step_deg_ = odd ? 0.0F : step;
  }
  kept_.assign(packet.begin(), packet.end());
  kept_came_ = came_at;
}

void PacketStream::emit_kept(ByteView next, float step_deg, std::vector<Sample>& out) {
  decode_capsule(*form_.packet, kept_, next, beams_);
  const float start = start_deg(*form_.packet, kept_);
  const float each = step_deg / static_cast<float>(form_.packet->samples);
  for (std::size_t k = 0; k < form_.packet->samples; ++k) {
    float turned = start + each * static_cast<float>(k);
    if (turned + each >= kTurn_deg) turned -= kTurn_deg;
    out.push_back({time_of(k, kept_came_), turned, turned - beams_[k].back_deg, range_m(beams_[k].range_mm),
                   anew_, gap_});
    anew_ = gap_ = false;
  }
}

void PacketStream::take_nodes(ByteView packet, Time came_at, std::vector<Sample>& out) {
  decode_nodes(*form_.packet, packet, nodes_);
  for (std::size_t k = 0; k < form_.packet->samples; ++k) {
    const Node& node = nodes_[k];
    if (node.first) {
      turned_deg_ = std::remainder(node.angle_deg, kTurn_deg);
    } else {
      float on = std::fmod(node.angle_deg - turned_deg_, kTurn_deg);
      if (on < -kMostBack_deg) on += kTurn_deg;
      if (on >= kTurn_deg - kMostBack_deg) on -= kTurn_deg;
      turned_deg_ += on;
    }
    if (turned_deg_ > kTurnOver_deg) turned_deg_ -= kTurn_deg;
    out.push_back({time_of(k, came_at), turned_deg_, turned_deg_, range_m(node.range_mm), anew_, false});
    anew_ = false;
  }
}

}  // namespace dynslam::rplidar
