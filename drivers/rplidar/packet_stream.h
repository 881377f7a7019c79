// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "base/time.h"
#include "drivers/rplidar/arrival_clock.h"
#include "drivers/rplidar/packets.h"

namespace dynslam::rplidar {

/// A beam as it was measured. Degrees are clockwise, and go on past the turn's start and end instead of
/// wrapping.
struct Sample {
  Time time;
  float turned_deg = 0.0F;  ///< how far the lidar has turned in this turn: about 0 to 360
  float angle_deg = 0.0F;   ///< where it looked, up to 10 degrees off
  float range_m = 0.0F;     ///< as Beam::range_m
  bool anew = false;        ///< the lidar's angle has nothing to do with the ones before
  bool after_gap = false;   ///< a capsule before it was lost
};

/// What the line carries.
struct StreamForm {
  const PacketForm* packet = nullptr;
  Duration sample{};  ///< from one beam to the next
  int baud = 0;       ///< ten of them a byte
  Duration delay{};   ///< of the adapter
};

/// How the line is doing.
struct StreamCounts {
  std::uint64_t packets = 0;
  std::uint64_t bad_checksums = 0;
  std::uint64_t skipped_bytes = 0;
  std::uint64_t odd_steps = 0;  ///< capsules that no motor can have turned through
};

/// Finds the packets among the bytes and decodes them. After lost or damaged bytes it looks for the next
/// packet: no more is lost than the damaged packet and the one before it.
class PacketStream {
 public:
  /// REQUIRES: a form, positive sample time and baud.
  explicit PacketStream(const StreamForm& form);

  /// Takes the bytes that have come until `read_at`, and appends what they complete.
  void feed(ByteView bytes, Time read_at, std::vector<Sample>& out);
  const StreamCounts& counts() const { return counts_; }

 private:
  bool is_witnessed(ByteView rest) const;
  std::size_t bytes_needed() const;
  void skip_byte();
  void drop_kept();
  Time read_time(std::size_t end, Time read_at) const;
  void take(ByteView packet, Time read_at, std::vector<Sample>& out);
  void take_capsule(ByteView packet, Time came_at, std::vector<Sample>& out);
  void emit_kept(ByteView next, float step_deg, std::vector<Sample>& out);
  void take_nodes(ByteView packet, Time came_at, std::vector<Sample>& out);
  Time time_of(std::size_t sample, Time came_at) const;

  StreamForm form_;
  std::vector<std::uint8_t> bytes_;
  std::size_t read_before_ = 0;  ///< how many of them came with earlier reads,
  Time before_at_;               ///< the last of which was then
  bool in_step_ = false;         ///< the byte before was the end of a packet
  ArrivalClock arrivals_;
  Duration byte_{};

  std::vector<std::uint8_t> kept_;  ///< the capsule before: decoded when the next one has come
  Time kept_came_;
  float usual_step_deg_ = 0.0F;  ///< from one capsule to the next; 0: not known
  bool gap_ = false;             ///< none was decoded since one was lost
  bool anew_ = true;
  float turned_deg_ = 0.0F;  ///< of the newest node
  CapsuleBeams beams_;
  Nodes nodes_;
  StreamCounts counts_;
};

}  // namespace dynslam::rplidar
