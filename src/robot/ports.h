// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "autopilot/order.h"
#include "autopilot/status.h"
#include "base/attitude.h"
#include "base/battery_state.h"
#include "base/cause.h"
#include "base/counters.h"
#include "base/drive_command.h"
#include "base/jpeg_frame.h"
#include "base/log_line.h"
#include "base/motor_state.h"
#include "base/scan.h"
#include "base/verdict.h"
#include "grid/world_state.h"
#include "pipe/bounded_queue.h"
#include "pipe/latest.h"
#include "pipe/recent.h"
#include "robot/device_health.h"
#include "robot/graph_view.h"

namespace dynslam {

/// What is driven and why, after a tick of the control.
struct DriveState {
  Time time;
  std::optional<DriveCommand> answered;  ///< the newest that the motors got their power for
  Time driven;                           ///< when they first had it
  Verdict verdict;
  Twist applied;
  WheelPower power;
  BatteryState battery;
  Cause cause = Cause::kNone;             ///< of the verdict
  std::optional<Attitude> attitude = {};  ///< nothing while no IMU tells it
  std::optional<bool> collision = {};     ///< a bumper is pressed; nothing when there are none
};

/// Whether what happens is to be recorded; newest wins.
struct RecordingWish {
  bool on = false;
  std::string file = {};  ///< where to; empty: a new one in the folder of recordings. Not for outsiders
};

struct RecordingState {
  bool active = false;
  bool asked_for = false;  ///< false: the ring, or nothing
  std::string file;        ///< the last one
  std::uint64_t bytes = 0, messages = 0;
  double seconds = 0.0;
  std::uint64_t dropped = 0;  ///< samples that came faster than they could be written, ever
  std::string trouble;        ///< why the last one ended before it was told to; empty when it did not
};

/// The pipes of a robot that outsiders may touch: the server, missions, recorders. Any thread.
struct Ports {
  // To the robot.
  Latest<DriveCommand> command;          ///< newest wins; each is a heartbeat too
  std::atomic<bool> driver_left{false};  ///< since the robot looked last; `command` may be another's by now
  std::atomic<double> power_limit{1.0};
  std::atomic<bool> supply_low{false};  ///< so says the computer of its own supply: driving goes easy on it
  BoundedQueue<std::string> stops{16};  ///< who asks for a stop; that there was one is never lost
  std::atomic<bool> clear_asked{
      false};                    ///< a person clears latched stops; a stop asked for at the same time wins
  std::atomic<int> watchers{0};  ///< of the video: the camera runs while there are any
  Latest<RecordingWish> recording_wish;
  BoundedQueue<LogLine> log{256};   ///< for recordings; one that begins has the lines before it too
  Recent<LogLine> recent_log{200};  ///< the same, for people
  /// A ray is believed this far (see SlamConfig); SLAM goes by it from the next scan on. At first, what the
  /// robot was made with.
  std::atomic<double> trusted_range_m{0.0};
  BoundedQueue<Order> orders{16};  ///< to the autopilot; the last one holds
  Latest<MapNotes> map_notes;      ///< what people drew on the map

  // From the robot.
  Latest<WorldState> world;
  Latest<Scan> scan;
  Latest<DriveState> drive;
  Latest<JpegFrame> video;
  Latest<GraphView> graph;  ///< after each local map that was worked off
  Latest<Counters> slam_counters, graph_counters, drive_counters;  ///< about once a second
  Latest<RecordingState> recording;
  Latest<AutopilotStatus> autopilot;
  Latest<DeviceHealth> lidar_health, imu_health, motors_health, camera_health, pins_health, wheels_health;
  Latest<DeviceHealth> computer_health;  ///< of the computer itself: its supply, its heat

  using NamedHealth = std::pair<const char*, const Latest<DeviceHealth>*>;
  std::array<NamedHealth, 7> device_healths() const {
    return {{{"lidar", &lidar_health},
             {"imu", &imu_health},
             {"motors", &motors_health},
             {"camera", &camera_health},
             {"pins", &pins_health},
             {"wheels", &wheels_health},
             {"computer", &computer_health}}};
  }

  /// What stages and devices counted; a device's names begin with its own.
  Counters counters() const;
};

}  // namespace dynslam
