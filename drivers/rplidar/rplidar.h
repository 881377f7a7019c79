// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "device/lidar.h"
#include "drivers/rplidar/packet_stream.h"
#include "drivers/rplidar/rplidar_start.h"
#include "drivers/rplidar/turn_builder.h"

namespace dynslam {

/// What `probe` shows of an RPLIDAR.
struct RplidarReport {
  rplidar::Portrait device;
  rplidar::StreamCounts line;  ///< since the program began
  std::uint64_t turns = 0;
  std::uint64_t holed_turns = 0;  ///< not handed out, as beams were missing
  double turns_per_s = 0.0;       ///< of the newest turn; 0 before there is one
};

/// An RPLIDAR on a serial line: A, C and S series, in whatever way of measuring they offer. Finds its port
/// and baud rate, starts and stops the motor; after an error it begins anew when asked again. Its beams go
/// clockwise: angles fall, from about 0 to -2 pi, and need not do so evenly.
class Rplidar : public Lidar {
 public:
  Rplidar(const RplidarConfig& config, const LidarMount& mount, const Clock& clock);
  ~Rplidar() override;

  std::optional<Scan> next(Time until) override;
  std::string about() const override;
  /// "bad-checksums", "skipped-bytes", "odd-steps", "holed-turns".
  Counters counters() const override;
  /// Asks it for all that the report says of the device, without spinning its motor where that has a choice.
  /// False: not yet by `until`; to be called again. Throws DeviceError.
  bool identify(Time until);
  RplidarReport report() const;

 private:
  void begin_measuring();
  std::optional<Scan> read_turn(Time until);
  void take(rplidar::ByteView bytes);
  void check_patience(Time now) const;
  void stop() noexcept;

  RplidarConfig config_;
  LidarMount mount_;
  const Clock& clock_;
  rplidar::Start start_;
  std::optional<rplidar::PacketStream> stream_;  ///< while it measures
  std::optional<rplidar::TurnBuilder> builder_;
  std::vector<rplidar::Sample> samples_;
  std::vector<Scan> ready_;   ///< oldest first
  Time packet_at_, turn_at_;  ///< the newest, or when it began to measure
  bool any_packet_ = false;
  RplidarReport past_;  ///< counts of what was measured before it began anew
};

}  // namespace dynslam
