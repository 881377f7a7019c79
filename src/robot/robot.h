// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "device/devices.h"
#include "drive/drive_config.h"
#include "robot/autopilot_stage.h"
#include "robot/control_stage.h"
#include "robot/ports.h"
#include "robot/recorder_stage.h"
#include "robot/sensor_stage.h"
#include "robot/slam_stage.h"
#include "robot/stop_signal.h"

namespace dynslam {

struct RobotConfig {
  SlamConfig slam;
  DriveConfig drive;
  AutopilotSetup autopilot;
  LidarMount lidar_mount;
  RecorderConfig recorder;
  RecordingAbout recording_about;
  /// The threads that must be in time, the control's and then the IMU's, go before all others, where that is
  /// allowed.
  bool timely_first = false;
};

/// The whole robot: its devices, and the stages between them and the ports (design, section 6). Runs in one
/// of two ways: with a thread a stage, or step by step in the caller's thread under a stepped clock,
/// repeatable to the bit.
class Robot {
 public:
  /// `clock` must outlive it. `watch`, when given, too: it is told of what step() does, by names of its own
  /// for what is not SLAM (kSensing and so on), and should not be given to threads.
  Robot(Devices devices, const RobotConfig& config, const Clock& clock, StageWatch* watch = nullptr);
  /// As stop().
  ~Robot();
  Robot(const Robot&) = delete;
  Robot& operator=(const Robot&) = delete;

  Ports& ports() { return ports_; }

  static constexpr std::string_view kSensing = "sensing", kMapping = "mapping", kPlanning = "planning",
                                    kPiloting = "piloting", kControlling = "controlling";

  /// Starts the threads.
  void start();
  /// Waits until one of the threads asks for a stop, or until `until`; returns whether one did.
  bool wait(Clock::SteadyTime until) const { return stop_.wait(until); }
  struct Ending {
    std::string trouble;  ///< what went wrong; empty when nothing did
    bool hangs = false;   ///< a thread hangs in a device: nothing is safe now but to end the program
  };
  /// Motors first, then everything else. No thread is waited for longer than `patience`; but the recorder's,
  /// which may have to wait for a disk, for some seconds.
  Ending stop(std::chrono::milliseconds patience = std::chrono::seconds(2));

  /// Instead of threads: works off all that is due by the clock.
  void step();

  /// Told of each scan, by the thread of SLAM.
  void on_scan(SlamStage::Notice notice) { notice_ = std::move(notice); }
  /// Takes in what is under way, ends a recording and draws the map for the last time. REQUIRES (these two):
  /// not started, or stopped.
  void finish();
  Slam& slam() { return slam_; }
  const DriveControl& control() const { return control_.control(); }
  Counters counters() const;

 private:
  void start_thread(const char* name, std::function<void()> turn, int priority = 0);
  void run_control();
  void control_turn();
  void run_recorder();
  void take(const ScanResult& result);
  void poll_camera();
  void enter(std::string_view stage) {
    if (watch_) watch_->enter(stage);
  }

  Devices devices_;
  StageWatch* watch_;
  bool timely_first_;
  const Clock& clock_;
  Ports ports_;
  StopSignal stop_;
  Latest<ImuSample> newest_imu_;
  Slam slam_;
  SlamStage slam_stage_;
  SlamStage::Notice notice_;
  AutopilotStage autopilot_;
  ControlStage control_;
  RecorderStage recorder_;
  std::uint64_t command_recorded_ = 0;  ///< version of the port; the thread of the control
  std::optional<SensorStage<Lidar>> lidar_;
  std::optional<SensorStage<Imu>> imu_;
  std::optional<SensorStage<Wheels>> wheels_;
  std::optional<SensorStage<Camera>> camera_;
  struct Thread {
    std::thread thread;
    std::future<void> ended;
    std::chrono::milliseconds grace{};  ///< it is waited for so much longer than the others
  };
  std::vector<Thread> threads_;
};

}  // namespace dynslam
