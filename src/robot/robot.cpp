// SPDX-License-Identifier: MIT
#include "robot/robot.h"

#include <exception>
#include <utility>

#include <pthread.h>
#include <sched.h>

namespace dynslam {
namespace {

constexpr Duration kNobodyWatches = std::chrono::milliseconds(100);
constexpr std::chrono::seconds kDiskPatience{5};
constexpr int kControlPriority = 20, kImuPriority = 10;

/// Without the right to it the thread is one among others.
void go_first(int priority) {
  sched_param param{};
  param.sched_priority = priority;
  pthread_setschedparam(pthread_self(), SCHED_FIFO, &param);
}

}  // namespace

Robot::Robot(Devices devices, const RobotConfig& config, const Clock& clock, StageWatch* watch)
    : devices_(std::move(devices)),
      watch_(watch),
      timely_first_(config.timely_first),
      clock_(clock),
      slam_(config.slam, watch),
      slam_stage_(slam_, ports_, clock),
      autopilot_(config.autopilot, config.drive, clock, ports_, newest_imu_),
      control_(devices_.motors.get(), devices_.pins.get(), config.drive, clock, ports_, newest_imu_,
               devices_.imu != nullptr),
      recorder_(config.recorder, config.recording_about, clock, ports_) {
  slam_.follow();
  slam_stage_.on_scan([this](const ScanResult& result) { take(result); });
  if (devices_.lidar) {
    const auto take = [this](Scan scan) {
      const auto shared = std::make_shared<const Scan>(std::move(scan));
      ports_.scan.put(shared);
      recorder_.add(shared);
      slam_stage_.add(shared);
    };
    lidar_.emplace(*devices_.lidar, take, clock, ports_.lidar_health);
  }
  if (devices_.imu) {
    const auto take = [this](const ImuSample& sample) {
      newest_imu_.put(sample);
      recorder_.add(sample);
      slam_stage_.add(sample);
    };
    imu_.emplace(*devices_.imu, take, clock, ports_.imu_health);
  }
  if (devices_.wheels) {
    const auto take = [this](const OdometrySample& sample) {
      recorder_.add(sample);
      slam_stage_.add(sample);
    };
    wheels_.emplace(*devices_.wheels, take, clock, ports_.wheels_health);
  }
  if (devices_.camera) {
    const auto take = [this](JpegFrame frame) {
      const auto shared = std::make_shared<const JpegFrame>(std::move(frame));
      ports_.video.put(shared);
      if (recorder_.wants_pictures()) recorder_.add(shared);
    };
    camera_.emplace(*devices_.camera, take, clock, ports_.camera_health);
  }
}

Robot::~Robot() { stop(); }

void Robot::start() {
  slam_.close_loops_elsewhere();
  recorder_.run_live();
  recorder_.turn();  // a recording that is wished for already misses nothing
  start_thread("recorder", [this] { run_recorder(); });
  threads_.back().grace = kDiskPatience;
  start_thread(
      "control", [this] { run_control(); }, kControlPriority);
  if (lidar_) start_thread("lidar", [this] { lidar_->turn(stop_); });
  if (imu_)
    start_thread(
        "imu", [this] { imu_->turn(stop_); }, kImuPriority);
  if (wheels_) start_thread("wheels", [this] { wheels_->turn(stop_); });
  if (camera_) start_thread("camera", [this] { poll_camera(); });
  start_thread("slam", [this] { slam_stage_.turn(); });
  start_thread("graph", [this] { slam_stage_.graph_turn(); });
  start_thread("autopilot", [this] {
    if (!stop_.wait(clock_.steady(autopilot_.plan_due()))) autopilot_.plan_turn();
  });
  start_thread("pilot", [this] {
    if (!stop_.wait(clock_.steady(autopilot_.pilot_due()))) autopilot_.pilot_turn();
  });
}

/// A thread takes turns until it is asked to stop, one at the least: the robot may have ended before the
/// thread began, and has to stand still all the same. What it throws ends the robot, not the program.
void Robot::start_thread(const char* name, std::function<void()> turn, int priority) {
  std::promise<void> ended;
  std::future<void> end = ended.get_future();
  auto run = [this, name, priority, turn = std::move(turn), ended = std::move(ended)]() mutable {
    if (timely_first_ && priority > 0) go_first(priority);
    try {
      do turn();
      while (!stop_.requested());
    } catch (const std::exception& e) {
      stop_.request(std::string(name) + ": " + e.what());
    }
    ended.set_value();
  };
  threads_.push_back({std::thread(std::move(run)), std::move(end), {}});
}

/// Ticks until the end, and stands still then, whatever it is that ends it.
void Robot::run_control() {
  try {
    while (!stop_.wait(clock_.steady(control_.due()))) control_turn();
  } catch (...) {
    control_.halt();
    throw;
  }
  control_.halt();
}

void Robot::run_recorder() {
  while (!stop_.requested()) recorder_.turn();
  recorder_.finish();
}

void Robot::control_turn() {
  control_.turn();
  if (!recorder_.active()) return;
  const auto command = ports_.command.get();
  if (command.value && std::exchange(command_recorded_, command.version) != command.version)
    recorder_.add(*command.value);
  recorder_.add(ports_.drive.get().value);
}

void Robot::take(const ScanResult& r) {
  recorder_.add(PoseFix{{r.stamp, r.map_T_robot, r.covariance, r.quality, r.lost, r.unsteady}, r.map_T_odom});
  if (notice_) notice_(r);
}

void Robot::poll_camera() {
  if (ports_.watchers > 0) {
    camera_->turn(stop_);
  } else {
    stop_.wait(clock_.steady(clock_.now() + kNobodyWatches));
  }
}

Robot::Ending Robot::stop(std::chrono::milliseconds patience) {
  stop_.request();
  slam_stage_.close();
  recorder_.close();
  const auto deadline = std::chrono::steady_clock::now() + patience;
  Ending ending;
  for (Thread& t : threads_) {
    if (t.ended.wait_until(deadline + t.grace) != std::future_status::ready) ending.hangs = true;
  }
  ending.trouble = stop_.trouble();
  if (ending.hangs) return ending;
  for (Thread& t : threads_) t.thread.join();
  threads_.clear();
  return ending;
}

void Robot::step() {
  recorder_.turn();
  enter(kSensing);
  if (imu_) {
    while (imu_->turn(stop_)) {
    }
  }
  if (wheels_) {
    while (wheels_->turn(stop_)) {
    }
  }
  if (lidar_) {
    while (lidar_->turn(stop_)) {
    }
  }
  if (camera_ && ports_.watchers > 0) camera_->turn(stop_);
  enter(kMapping);
  slam_stage_.turn();
  if (clock_.now() >= autopilot_.plan_due()) {
    enter(kPlanning);
    autopilot_.plan_turn();
  }
  if (clock_.now() >= autopilot_.pilot_due()) {
    enter(kPiloting);
    autopilot_.pilot_turn();
  }
  if (clock_.now() >= control_.due()) {
    enter(kControlling);
    control_turn();
  }
}

void Robot::finish() {
  recorder_.finish();
  slam_stage_.finish();
}

Counters Robot::counters() const {
  Counters all = slam_.counters();
  for (const auto& [name, n] : slam_stage_.queue_counters()) all.add(name, n);
  if (recorder_.dropped() > 0) all.add("queue.recorder_dropped", recorder_.dropped());
  for (const auto& [name, n] : control_.control().refused()) all.add(name, n);
  return all;
}

}  // namespace dynslam
