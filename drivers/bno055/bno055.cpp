// SPDX-License-Identifier: MIT
#include "drivers/bno055/bno055.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <utility>

#include "base/angles.h"

namespace dynslam {
namespace {

using bno055::MotionReading;
using bno055::Nonsense;
using bno055::Status;
using std::chrono::milliseconds;

constexpr int kMostBad = 5;
constexpr int kMostBadStatuses = 3;
constexpr int kMostFrozenLooks = 4;
/// A transfer that took so much longer than the quickest was interrupted, who knows where.
constexpr Duration kInterruption = milliseconds(8);
constexpr Duration kLookEvery = std::chrono::seconds(1);
constexpr double kRate_hz = 100.0, kSoftwareBusRate_hz = 50.0;
constexpr double kStill_radps = 0.03;
constexpr int kMostWarming_c = 2;  ///< from one look to the next
constexpr int kWellCalibrated = 3;

}  // namespace

Bno055::Bno055(const Bno055Config& config, const Clock& clock, ProfileStore store)
    : config_(config),
      clock_(clock),
      store_(std::move(store)),
      chip_("imu", config.bus, config.address),
      start_up_(config, clock, chip_) {
  load_profile();
}

void Bno055::load_profile() {
  if (!store_.load) return;
  profile_kept_ = store_.load();
  if (!profile_kept_) return;
  const auto profile = bno055::read_profile(*profile_kept_);
  if (!profile) chip_.count("profile-bad");
  start_up_.set_profile(profile);
}

void Bno055::save_profile() {
  if (!store_.save || !start_up_.profile()) return;
  const std::string text = bno055::profile_text(*start_up_.profile());
  if (text == profile_kept_) return;
  try {
    store_.save(text);
    profile_kept_ = text;
    chip_.count("profile-saved");
  } catch (const std::exception&) {
    chip_.count("profile-unsaved");
  }
}

std::optional<ImuSample> Bno055::next(Time until) {
  if (!start_up_.go_on(until)) return std::nullopt;
  if (start_up_.beginnings() != beginning_) begin();
  while (start_up_.is_done() && due_ <= until) {
    bno055::wait_until(clock_, due_);
    if (auto sample = read()) return sample;
  }
  if (start_up_.is_done()) bno055::wait_until(clock_, until);
  return std::nullopt;
}

void Bno055::begin() {
  beginning_ = start_up_.beginnings();
  if (profile_found_) save_profile();
  const double usual_hz = chip_.is_software_bus() ? kSoftwareBusRate_hz : kRate_hz;
  period_ = from_seconds(1.0 / (config_.rate_hz > 0.0 ? config_.rate_hz : usual_hz));
  due_ = clock_.now();
  status_due_ = due_;
  turned_ = due_;
  check_.forget();
  quickest_ = Duration::max() / 2;
  bad_readings_ = bad_statuses_ = frozen_looks_ = 0;
  temperature_c_.reset();
  changed_ = joins_ = true;
  const std::lock_guard lock(report_mutex_);
  report_.running = true;
  report_.identity = start_up_.identity();
  report_.status = start_up_.status();
  report_.has_profile = start_up_.profile().has_value();
  report_.on_software_bus = chip_.is_software_bus();
}

/// Readings that were missed are not made up for.
void Bno055::schedule(Time now) {
  due_ += period_;
  if (due_ > now) return;
  const auto missed = (now - due_) / period_ + 1;
  chip_.count("skipped", static_cast<std::uint64_t>(missed));
  due_ += missed * period_;
}

std::optional<ImuSample> Bno055::read() {
  bno055::MotionBytes bytes{};
  const Time begun = clock_.now();
  const int error = chip_.read_registers(bno055::kMotion, bytes);
  const Time ended = clock_.now();
  schedule(ended);
  if (error) {
    if (++bad_readings_ >= kMostBad) give_up(chip_.failure(error));
    return std::nullopt;
  }
  quickest_ = std::min(quickest_, ended - begun);
  changed_ = changed_ || bytes != newest_;
  newest_ = bytes;
  const Time stamp = begun + (ended - begun) / 2 - from_seconds(config_.latency_s);
  const MotionReading reading = bno055::decode_motion(bytes);
  if (ended - begun > quickest_ + kInterruption) {
    chip_.count("late");
  } else if (is_sound(stamp, reading)) {
    const ImuSample sample = join(stamp, reading.motion.world_q_robot);
    look_after(ended);
    return sample;
  }
  look_after(ended);
  return std::nullopt;
}

bool Bno055::is_sound(Time stamp, const MotionReading& reading) {
  Nonsense nonsense = reading.nonsense;
  if (nonsense == Nonsense::kNone) nonsense = check_.check(stamp, reading.motion);
  if (nonsense == Nonsense::kNone) {
    bad_readings_ = 0;
    if (reading.motion.rate_radps.norm() > kStill_radps) turned_ = stamp;
    const std::lock_guard lock(report_mutex_);
    report_.motion = reading.motion;
    return true;
  }
  chip_.count(bno055::to_string(nonsense));
  if (++bad_readings_ < kMostBad) return false;
  give_up(DeviceError("imu: five readings in a row made no sense (" + std::string(to_string(nonsense)) +
                      "): the chip is reset; if that goes on, look at its wires and its bus"));
}

/// Turns what the chip says about the vertical, so that the heading goes on where it was.
ImuSample Bno055::join(Time stamp, const Eigen::Quaterniond& chip_q_robot) {
  if (std::exchange(joins_, false) && heading_rad_)
    heading_off_rad_ = wrap_angle(*heading_rad_ - yaw_of(chip_q_robot));
  const Eigen::AngleAxisd turn(heading_off_rad_, Eigen::Vector3d::UnitZ());
  const ImuSample sample{stamp, turn * chip_q_robot};
  heading_rad_ = yaw_of(sample.world_q_robot);
  return sample;
}

/// Once a second, and at every reading while there is something odd.
void Bno055::look_after(Time now) {
  if (now < status_due_) return;
  const std::optional<Status> status = read_status();
  if (!status) {
    chip_.count("status");
    if (++bad_statuses_ < kMostBadStatuses) return;
    give_up(
        DeviceError("imu: the chip does not measure any more: it is reset; if that goes on, look at "
                    "its supply"));
  }
  bad_statuses_ = 0;
  status_due_ = now + kLookEvery;
  temperature_c_ = status->temperature_c;
  {
    const std::lock_guard lock(report_mutex_);
    report_.status = *status;
  }
  watch_freezing();
  const bool stands = now - turned_ > kLookEvery;
  if (!store_.save || profile_found_ || !stands || !is_calibrated(status->calibration)) return;
  profile_found_ = true;
  start_up_.read_profile_again();
}

/// Nothing when it cannot be, or the chip does not fuse.
std::optional<Status> Bno055::read_status() {
  bno055::StatusBytes bytes{};
  if (chip_.read_registers(bno055::kStatus, bytes) != 0) return std::nullopt;
  const std::optional<Status> status = bno055::decode_status(bytes);
  if (!status || !status->is_fusing(start_up_.mode())) return std::nullopt;
  if (temperature_c_ && std::abs(status->temperature_c - *temperature_c_) > kMostWarming_c)
    return std::nullopt;
  return status;
}

/// A robot that stands gives the same orientation for ever, but its accelerometer is never quite at rest.
void Bno055::watch_freezing() {
  std::array<std::uint8_t, 6> acceleration{};
  if (chip_.read_registers(bno055::kAcceleration, acceleration) != 0) return;
  const bool same = !changed_ && acceleration == acceleration_;
  frozen_looks_ = same ? frozen_looks_ + 1 : 0;
  acceleration_ = acceleration;
  changed_ = false;
  if (same) status_due_ = due_;
  if (frozen_looks_ < kMostFrozenLooks) return;
  chip_.count("frozen");
  give_up(DeviceError("imu: the chip says the same for ever: it is reset"));
}

bool Bno055::is_calibrated(const bno055::Calibration& c) const {
  const bool turns = c.gyroscope == kWellCalibrated && c.accelerometer == kWellCalibrated;
  return turns && (!config_.use_compass || c.magnetometer == kWellCalibrated);
}

void Bno055::give_up(const DeviceError& why) {
  start_up_.restart();
  {
    const std::lock_guard lock(report_mutex_);
    report_.running = false;
  }
  throw why;
}

std::string Bno055::about() const {
  const Bno055Report now = report();
  if (!now.running) return {};
  const auto& c = now.status.calibration;
  std::string text = "BNO055 on " + config_.bus + ", calibrated (0 to 3): gyroscope " +
                     std::to_string(c.gyroscope) + ", accelerometer " + std::to_string(c.accelerometer);
  if (config_.use_compass) text += ", compass " + std::to_string(c.magnetometer);
  return text;
}

Bno055Report Bno055::report() const {
  const std::lock_guard lock(report_mutex_);
  return report_;
}

}  // namespace dynslam
