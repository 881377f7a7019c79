// SPDX-License-Identifier: MIT
#pragma once

#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "base/pin_state.h"
#include "device/devices.h"
#include "pipe/clock.h"
#include "sim/life.h"
#include "sim/world.h"

namespace dynslam {

/// How things stand in truth. The robot must never be told.
struct SimTruth {
  Time now;  ///< of the last step
  Pose2 world_T_robot;
  Twist twist;
  double distance_m = 0.0;
  int contacts = 0;
  int kicks = 0;  ///< how often it was carried off
  double battery_share = 1.0, battery_v = 0.0;
};

/// A world, a robot in it, and its hardware, in the time of a clock. Whoever asks for something first brings
/// the simulation up to the clock's now, in fixed steps: what happens depends on the world, the seed and what
/// was commanded when, not on who asks. Under a stepped clock it is repeatable to the bit, and nothing waits.
/// All calls may come from any thread.
class Simulator {
 public:
  /// Begins at the clock's now. REQUIRES: the clock outlives it.
  Simulator(World world, const Clock& clock, std::uint64_t seed = 1);

  const World& world() const { return world_; }

  /// From now on, in place of what the world's schedule says. Throws InputError where can_have is false.
  void set_fault(SimDevice device, FaultKind kind);
  /// Ends set_fault; the world's schedule holds again.
  void clear_fault(SimDevice device);
  /// Somebody carries the robot: to a pose as seen from where it is. False where something stands.
  bool kick(const Pose2& robot_T_new);
  void press_estop(bool pressed);
  /// Somebody opens or closes a door of world().doors, by its place there: 0 closed, 1 wide open. From then
  /// on its schedule does not count. REQUIRES: there is such a door.
  void move_door(std::size_t door, double open);
  /// How much of the battery is left, 0 to 1.
  void set_battery(double share);

  SimTruth truth();
  /// Around the robot, as things stand.
  Room room();
  /// A face that the robot is pressed to.
  std::optional<Surface> touched();
  /// Points of the floor that the robot could drive to from where it is, as things stand: `step_m` apart,
  /// around where it is.
  std::vector<Vector2> reachable_floor(double step_m);
  /// Where the robot was; nothing before what is kept (Life::kTruthKept) and after now.
  std::optional<Pose2> true_pose(Time t);
  /// 100 poses a second, those after a time, oldest first.
  std::vector<TruePose> truth_since(Time after);

  // What the devices do; as their interfaces say.
  std::optional<Scan> next_scan(Time until);
  std::optional<ImuSample> next_imu(Time until);
  std::optional<CameraView> next_view(Time until);
  void drive(const WheelPower& power);
  MotorState read_motors();
  PinState read_pins();

  static constexpr Duration kFaultDelay = std::chrono::milliseconds(500);
  /// A bus gives up on a silent device after this.
  static constexpr Duration kBusTimeout = std::chrono::milliseconds(50);

 private:
  struct Command {
    Time at;
    WheelPower power;
  };
  using Lock = std::unique_lock<std::mutex>;

  /// Brings the simulation up to the clock; returns the clock's now.
  Time catch_up();
  void kick_on_schedule();
  bool carry(const Pose2& robot_T_new);
  std::optional<FaultKind> fault_of(SimDevice device, Time now) const;
  /// For motors and pins: throws if the device is unplugged or, after waiting, silent; else its fault.
  std::optional<FaultKind> answer(SimDevice device, Lock& lock);
  void sleep_until(Time t, Lock& lock);
  template <class T, class NextDue>
  std::optional<T> next(SimDevice device, Outbox<T>& box, std::optional<T>& last, Time until,
                        NextDue&& next_due);

  const World world_;
  const Clock& clock_;
  const Time begin_;
  const bool waits_;  ///< whether the clock moves by itself, so that one can wait by it

  std::mutex mutex_;  ///< guards all below
  std::condition_variable changed_;
  Life life_;
  RandomStream volts_random_;
  std::array<std::optional<FaultKind>, kSimDevices> faults_;
  std::deque<Command> late_commands_;  ///< of a delayed motor board
  std::optional<Scan> last_scan_;
  std::optional<ImuSample> last_imu_;
  std::optional<CameraView> last_view_;
  std::optional<MotorState> last_motors_;
  PinState last_pins_;
  std::size_t next_kick_ = 0;
  int kicks_ = 0;
  bool estop_ = false;
  Time estop_since_;
};

/// All of the simulated robot's hardware. Each keeps the simulator alive.
Devices make_devices(const std::shared_ptr<Simulator>& simulator);

}  // namespace dynslam
