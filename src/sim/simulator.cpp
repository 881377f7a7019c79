// SPDX-License-Identifier: MIT
#include "sim/simulator.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "device/device_error.h"

namespace dynslam {
namespace {

constexpr double kVoltStep = 36.3 / 1023;                           // the board's converter has 10 bits
constexpr Duration kLongestSleep = std::chrono::milliseconds(100);  // faults come and go unannounced
constexpr std::size_t kMostLateCommands = 256;

double wrong_number(FaultKind kind) {
  return kind == FaultKind::kNan ? std::numeric_limits<double>::quiet_NaN()
                                 : std::numeric_limits<double>::infinity();
}

bool is_wrong_number(FaultKind kind) { return kind == FaultKind::kNan || kind == FaultKind::kInfinite; }

// One overload for each kind of sample: what a device with this fault makes of it.

void falsify(Scan& scan, FaultKind kind) {
  if (is_wrong_number(kind)) {
    for (Beam& b : scan.beams) b.range_m = static_cast<float>(wrong_number(kind));
  } else if (kind == FaultKind::kMirrored) {
    for (Beam& b : scan.beams) b.angle_rad = -b.angle_rad;
  }
}

void falsify(ImuSample& sample, FaultKind kind) {
  Eigen::Quaterniond& q = sample.world_q_robot;
  if (is_wrong_number(kind)) {
    q.coeffs().setConstant(wrong_number(kind));
  } else if (kind == FaultKind::kMirrored) {
    q = Eigen::Quaterniond(q.w(), -q.x(), q.y(), -q.z());
  }
}

void falsify(CameraView&, FaultKind) {}

[[noreturn]] void throw_unplugged(SimDevice device) {
  throw DeviceError(std::string(kSimDeviceNames[static_cast<std::size_t>(device)]) +
                    ": unplugged (simulated): is its cable in?");
}

[[noreturn]] void throw_silent(SimDevice device) {
  throw DeviceError(std::string(kSimDeviceNames[static_cast<std::size_t>(device)]) +
                    ": no answer within 50 ms (simulated): has it power?");
}

}  // namespace

Simulator::Simulator(World world, const Clock& clock, std::uint64_t seed)
    : world_(std::move(world)),
      clock_(clock),
      begin_(clock.now()),
      waits_(clock.steady(begin_) != clock.steady(begin_ + kLongestSleep)),
      life_(world_, begin_, seed),
      volts_random_(seed, 4),
      estop_since_(begin_ - kFaultDelay) {}

Time Simulator::catch_up() {
  const Time now = clock_.now();
  while (life_.now() + Life::kStep <= now) {
    while (!late_commands_.empty() && late_commands_.front().at <= life_.now()) {
      life_.command(late_commands_.front().power, late_commands_.front().at);
      late_commands_.pop_front();
    }
    kick_on_schedule();
    life_.step();
  }
  return now;
}

void Simulator::kick_on_schedule() {
  const std::vector<ScheduledKick>& kicks = world_.kicks;
  for (const double now_s = to_seconds(life_.now() - begin_);
       next_kick_ < kicks.size() && kicks[next_kick_].at_s <= now_s; ++next_kick_)
    carry(kicks[next_kick_].robot_T_new);
}

bool Simulator::carry(const Pose2& robot_T_new) {
  const bool carried = life_.place(life_.body().pose().world_T_robot * robot_T_new);
  if (carried) ++kicks_;
  return carried;
}

std::optional<FaultKind> Simulator::fault_of(SimDevice device, Time now) const {
  if (const auto& commanded = faults_[static_cast<std::size_t>(device)]) return commanded;
  const double now_s = to_seconds(now - begin_);
  for (const ScheduledFault& f : world_.faults) {
    if (f.device == device && f.at_s <= now_s && now_s < f.until_s) return f.kind;
  }
  return std::nullopt;
}

void Simulator::sleep_until(Time t, Lock& lock) { changed_.wait_until(lock, clock_.steady(t)); }

template <class T, class NextDue>
std::optional<T> Simulator::next(SimDevice device, Outbox<T>& box, std::optional<T>& last, Time until,
                                 NextDue&& next_due) {
  Lock lock(mutex_);
  while (true) {
    const Time now = catch_up();
    const auto fault = fault_of(device, now);
    const Duration delay = fault == FaultKind::kDelayed ? kFaultDelay : Duration::zero();
    if (fault == FaultKind::kUnplugged || fault == FaultKind::kSilent) box.clear();
    if (fault == FaultKind::kUnplugged) throw_unplugged(device);
    if (auto sample = box.take(now - delay)) {
      if (fault == FaultKind::kFrozen && last) {
        const Time stamp = sample->stamp;
        *sample = *last;
        sample->stamp = stamp;
      }
      last = sample;
      if (fault) falsify(*sample, *fault);
      return sample;
    }
    if (now >= until || !waits_) return std::nullopt;
    sleep_until(std::min({until, std::max(now, next_due() + delay), now + kLongestSleep}), lock);
  }
}

std::optional<Scan> Simulator::next_scan(Time until) {
  return next(SimDevice::kLidar, life_.scans, last_scan_, until, [&] { return life_.next_scan_due(); });
}

std::optional<ImuSample> Simulator::next_imu(Time until) {
  return next(SimDevice::kImu, life_.imu, last_imu_, until, [&] { return life_.next_imu_due(); });
}

std::optional<CameraView> Simulator::next_view(Time until) {
  return next(SimDevice::kCamera, life_.views, last_view_, until, [&] { return life_.next_view_due(); });
}

std::optional<FaultKind> Simulator::answer(SimDevice device, Lock& lock) {
  const Time now = catch_up();
  const auto fault = fault_of(device, now);
  if (fault == FaultKind::kUnplugged) throw_unplugged(device);
  if (fault != FaultKind::kSilent) return fault;
  for (const Time end = now + kBusTimeout; waits_ && clock_.now() < end;) sleep_until(end, lock);
  throw_silent(device);
}

void Simulator::drive(const WheelPower& power) {
  Lock lock(mutex_);
  const auto fault = answer(SimDevice::kMotors, lock);
  const Time now = clock_.now();
  if (fault == FaultKind::kFrozen) return;
  if (fault != FaultKind::kDelayed) {
    late_commands_.clear();
    life_.command(power, now);
  } else if (late_commands_.size() < kMostLateCommands) {
    late_commands_.push_back({now + kFaultDelay, power});
  }
}

MotorState Simulator::read_motors() {
  Lock lock(mutex_);
  const auto fault = answer(SimDevice::kMotors, lock);
  if (fault == FaultKind::kFrozen && last_motors_) return *last_motors_;
  MotorState state;
  const double volts = life_.body().battery().voltage_v() + 0.02 * volts_random_.normal();
  state.battery_v = std::clamp(std::round(volts / kVoltStep), 0.0, 1023.0) * kVoltStep;
  state.failsafe_on = true;
  last_motors_ = state;
  if (fault && is_wrong_number(*fault)) state.battery_v = wrong_number(*fault);
  return state;
}

PinState Simulator::read_pins() {
  Lock lock(mutex_);
  const auto fault = answer(SimDevice::kPins, lock);
  if (fault == FaultKind::kFrozen) return last_pins_;
  const bool is_late = fault == FaultKind::kDelayed && clock_.now() - estop_since_ < kFaultDelay;
  last_pins_.estop_pressed = is_late ? !estop_ : estop_;
  last_pins_.bumper_pressed = life_.body().touches();
  return last_pins_;
}

void Simulator::set_fault(SimDevice device, FaultKind kind) {
  if (!can_have(device, kind)) {
    throw InputError(std::string(kSimDeviceNames[static_cast<std::size_t>(device)]) + " cannot be " +
                     std::string(kFaultNames[static_cast<std::size_t>(kind)]));
  }
  const Lock lock(mutex_);
  catch_up();
  faults_[static_cast<std::size_t>(device)] = kind;
  changed_.notify_all();
}

void Simulator::clear_fault(SimDevice device) {
  const Lock lock(mutex_);
  catch_up();
  faults_[static_cast<std::size_t>(device)].reset();
  changed_.notify_all();
}

bool Simulator::kick(const Pose2& robot_T_new) {
  const Lock lock(mutex_);
  catch_up();
  return carry(robot_T_new);
}

void Simulator::press_estop(bool pressed) {
  const Lock lock(mutex_);
  catch_up();
  if (pressed == estop_) return;
  estop_ = pressed;
  estop_since_ = clock_.now();
}

void Simulator::move_door(std::size_t door, double open) {
  const Lock lock(mutex_);
  catch_up();
  life_.move_door(door, open);
}

void Simulator::set_battery(double share) {
  const Lock lock(mutex_);
  catch_up();
  life_.body().battery().set_share(share);
}

SimTruth Simulator::truth() {
  const Lock lock(mutex_);
  catch_up();
  const RobotBody& body = life_.body();
  return {life_.now(),
          body.pose().world_T_robot,
          body.twist(),
          body.distance_m(),
          body.contacts(),
          kicks_,
          body.battery().share(),
          body.battery().voltage_v()};
}

Room Simulator::room() {
  const Lock lock(mutex_);
  catch_up();
  return life_.room();
}

std::optional<Surface> Simulator::touched() {
  const Lock lock(mutex_);
  catch_up();
  return life_.touched();
}

std::vector<Vector2> Simulator::reachable_floor(double step_m) {
  const Lock lock(mutex_);
  catch_up();
  return life_.reachable_floor(step_m);
}

std::optional<Pose2> Simulator::true_pose(Time t) {
  const Lock lock(mutex_);
  catch_up();
  const auto& truth = life_.truth();
  const auto after = std::lower_bound(truth.begin(), truth.end(), t,
                                      [](const TruePose& p, Time stamp) { return p.stamp < stamp; });
  if (after == truth.end()) return std::nullopt;
  if (after->stamp == t) return after->world_T_robot;
  if (after == truth.begin()) return std::nullopt;
  const TruePose& before = *std::prev(after);
  const double share = to_seconds(t - before.stamp) / to_seconds(after->stamp - before.stamp);
  return interpolate(before.world_T_robot, after->world_T_robot, share);
}

std::vector<TruePose> Simulator::truth_since(Time after) {
  const Lock lock(mutex_);
  catch_up();
  const auto& truth = life_.truth();
  const auto first = std::upper_bound(truth.begin(), truth.end(), after,
                                      [](Time stamp, const TruePose& p) { return stamp < p.stamp; });
  return {first, truth.end()};
}

}  // namespace dynslam
