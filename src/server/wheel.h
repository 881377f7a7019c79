// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "pipe/clock.h"
#include "robot/ports.h"
#include "server/access/driver_lease.h"
#include "server/delay_histogram.h"

namespace dynslam {

/// The fastest that may be asked for.
struct TwistLimits {
  double v_mps = 2.2, w_radps = 3.0;
};

/// Between those who want to drive and the robot: one of them holds the wheel, and only he commands. What he
/// commands is stamped with the robot's clock; when he is gone the robot stops. A robot that drives by itself
/// goes on doing so until he steers: that somebody only watches from the driver's seat is no command, and
/// what is ordered of its autopilot makes an onlooker of whoever steered. Any thread.
class Wheel {
 public:
  using Client = DriverLease::Client;
  using SteadyTime = DriverLease::SteadyTime;

  /// `drives_itself` says whether the robot does though it has no active autopilot; empty: never.
  Wheel(Ports& ports, const Clock& clock, const TwistLimits& limits, std::function<bool()> drives_itself = {})
      : ports_(ports), clock_(clock), limits_(limits), drives_itself_(std::move(drives_itself)) {}

  /// A number for a client that may want to drive.
  Client enter();
  /// The client is gone: if it held the wheel, the robot stops at once and the wheel is free.
  void leave(Client client);

  /// Whether the client holds the wheel then: it was free, its own, forgotten, or is taken over. `id`: of
  /// what let him in.
  bool acquire(Client client, const std::string& name, bool take_over, SteadyTime now,
               const std::string& id = {});
  void release(Client client);
  /// The holder is still there.
  void touch(Client client, SteadyTime now);

  /// Whether the holder has steered since he took the wheel.
  bool is_steered() const;

  /// Gives the autopilot an order, unless somebody else than the one whom `id` let in steers: then nothing
  /// happens, and his name is returned. Nobody steers after that until he pushes again.
  std::optional<std::string> order(Order order, const std::string& id, SteadyTime now);

  struct Sent {
    std::uint64_t seq = 0;  ///< as the robot sees it; 0 when it did not have to be told
    Time heard;
  };
  /// Commands the wanted, clamped, if the client holds the wheel. REQUIRES: finite.
  std::optional<Sent> drive(Client client, const Twist& wanted);

  struct Holder {
    bool mine = false;
    std::optional<std::string> driver;
    bool operator==(const Holder&) const = default;
  };
  Holder holder(Client client) const;

  struct Answered {
    std::uint64_t seq = 0;  ///< as in Sent
    Duration delay{};       ///< from when it was heard to the motors' power
  };
  /// The last command that the motors answered.
  std::optional<Answered> answered();

  struct Delays {
    DelayHistogram command_to_motor, drop_to_off;
  };
  Delays delays();

 private:
  Sent command(const Twist& twist, bool gone);
  bool is_hands_off() const;
  void note_answered();

  Ports& ports_;
  const Clock& clock_;
  TwistLimits limits_;
  std::function<bool()> drives_itself_;
  mutable std::mutex mutex_;
  Client clients_ = 0;
  DriverLease lease_;
  bool steered_ = false;
  std::uint64_t seq_ = 0;
  std::optional<Answered> answered_;
  Delays delays_;
};

}  // namespace dynslam
