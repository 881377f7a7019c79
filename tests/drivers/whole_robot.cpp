// SPDX-License-Identifier: MIT
#include "drivers/whole_robot.h"

#include <cmath>
#include <utility>

#include <nlohmann/json.hpp>

#include "real_devices.h"
#include "robot_config.h"
#include "server/state_json.h"

namespace dynslam::test {
namespace {

using std::chrono::milliseconds;

constexpr double kStands_mps = 0.005, kStands_radps = 0.01;
constexpr double kGoes_mps = 0.03, kGoes_radps = 0.1;

}  // namespace

Hand::Hand(Ports& ports, const Clock& clock, Wish wish)
    : ports_(ports),
      clock_(clock),
      wish_(std::move(wish)),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

void Hand::run(const std::stop_token& stop) {
  for (std::uint64_t seq = 1; !stop.stop_requested(); ++seq) {
    const auto world = ports_.world.get().value;
    const auto drive = ports_.drive.get().value;
    const Verdict verdict = drive ? drive->verdict : Verdict{};
    const Twist twist = wish_(clock_.now(), world ? world->pose : PoseEstimate{}, verdict);
    ports_.command.put({seq, verdict.motion >= Motion::kStop ? Twist{} : twist, clock_.now()});
    std::this_thread::sleep_for(milliseconds(50));
  }
}

void WholeRobot::begin(const World& world, EmulatedHardware::Plugged plugged) {
  hardware_.reset();  // there can be only one
  hardware_ = std::make_unique<EmulatedHardware>(world, plugged);
  config_ = hardware_->config();
}

void WholeRobot::start(const std::function<void(Devices&)>& wrap) {
  Devices devices = make_real_devices(config_, hardware_->clock);
  if (wrap) wrap(devices);
  RobotConfig own = robot_config(config_);
  own.timely_first = true;
  robot_ = std::make_unique<Robot>(std::move(devices), own, hardware_->clock);
  robot_->start();
}

void WholeRobot::hold(const Twist& twist) {
  drive_by([twist](Time, const PoseEstimate&, const Verdict&) { return twist; });
}

void WholeRobot::drive_by(Hand::Wish wish) {
  hand_.reset();
  hand_ = std::make_unique<Hand>(ports(), hardware_->clock, std::move(wish));
}

void WholeRobot::TearDown() {
  hand_.reset();
  if (!robot_) return;
  const Robot::Ending ending = robot_->stop();
  EXPECT_FALSE(ending.hangs);
  EXPECT_EQ(ending.trouble, "");
  EXPECT_EQ(hardware_->motors.power_a(), 0.0);
  EXPECT_EQ(hardware_->motors.power_b(), 0.0);
}

std::optional<double> WholeRobot::comes_true(double seconds, const std::function<bool()>& what) {
  const Time begin = now();
  while (now() - begin < from_seconds(seconds)) {
    if (what()) return to_seconds(now() - begin);
    std::this_thread::sleep_for(milliseconds(2));
  }
  return std::nullopt;
}

DriveState WholeRobot::drive() {
  const auto state = ports().drive.get().value;
  return state ? *state : DriveState{};
}

nlohmann::json WholeRobot::device(const std::string& name) { return devices_json(ports())["devices"][name]; }

std::string WholeRobot::trouble(const std::string& name) {
  const nlohmann::json shown = device(name);  // null: it did not say anything yet
  return shown.is_object() ? shown.value("trouble", "") : "";
}

bool WholeRobot::goes() {
  const Twist twist = hardware_->world.twist();
  return drive().verdict.motion < Motion::kHold &&
         (std::abs(twist.v_mps) > kGoes_mps || std::abs(twist.w_radps) > kGoes_radps);
}

bool WholeRobot::stands() {
  const Twist twist = hardware_->world.twist();
  return std::abs(twist.v_mps) < kStands_mps && std::abs(twist.w_radps) < kStands_radps;
}

std::string WholeRobot::state() {
  const Verdict verdict = drive().verdict;
  return std::string(to_string(verdict.motion)) + ": " + verdict.reason + "\n" +
         devices_json(ports())["devices"].dump(2);
}

}  // namespace dynslam::test
