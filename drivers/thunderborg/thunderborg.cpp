// SPDX-License-Identifier: MIT
#include "drivers/thunderborg/thunderborg.h"

#include <cmath>
#include <cstdlib>

namespace dynslam {
namespace {

constexpr Duration kPause = std::chrono::milliseconds(200);

/// Not so bright as to dazzle.
LightColor color_of(Motion motion) {
  switch (motion) {
    case Motion::kGo:
      return {0, 80, 0};
    case Motion::kSlow:
    case Motion::kHold:
      return {80, 50, 0};
    case Motion::kStop:
      return {80, 0, 0};
    case Motion::kEStop:
      break;
  }
  return {80, 0, 80};
}

std::optional<std::uint8_t> decode_byte(const thunderborg::Answer& answer) { return answer[1]; }

}  // namespace

ThunderBorg::ThunderBorg(const ThunderBorgConfig& config, const Clock& clock)
    : config_(config), clock_(clock), board_("motors", config.bus, config.address) {
  try {
    begin();
  } catch (const DeviceError&) {
    switch_off();  // told when it is asked for something
  }
}

ThunderBorg::~ThunderBorg() {
  switch_off();
  if (light_shown_ == kBatteryLight) return;
  try {
    tell(Command::kShowBattery, {1});
  } catch (const DeviceError&) {
  }
}

std::string ThunderBorg::about() const {
  return trusted_ ? "ThunderBorg on " + config_.bus + ", its failsafe on" : std::string();
}

template <class Act>
auto ThunderBorg::trusting(Act&& act) {
  if (!trusted_ && clock_.now() < ask_again_) throw DeviceError(trouble_);
  try {
    if (!trusted_) begin();
    return act();
  } catch (const DeviceError& e) {
    distrust(e.what());
    throw;
  }
}

void ThunderBorg::begin() {
  tell(Command::kAllOff);
  if (ask(Command::kGetIdentity, &decode_byte) != thunderborg::kIdentity)
    throw DeviceError("motors: what answers is no ThunderBorg: look at motors.address");
  switch_failsafe_on();
  light_shown_ = kBatteryLight;
  read_fault(Command::kGetFaultA);
  read_fault(Command::kGetFaultB);
  trusted_ = true;
}

void ThunderBorg::switch_failsafe_on() {
  for (int tried = 0; tried < I2cDevice::kTries; ++tried) {
    tell(Command::kSetFailsafe, {1});
    if (ask(Command::kGetFailsafe, &thunderborg::decode_flag)) return;
    board_.count("readback");
  }
  throw DeviceError("motors: the board's failsafe cannot be switched on: is it a ThunderBorg, and well?");
}

/// As far as it can; for when nothing else can be done.
void ThunderBorg::switch_off() {
  trusted_ = false;
  if (board_.write(static_cast<std::uint8_t>(Command::kAllOff)) != 0) board_.count("not-switched-off");
}

void ThunderBorg::distrust(const std::string& why) {
  board_.count("distrusted");
  switch_off();
  trouble_ = why;
  ask_again_ = clock_.now() + kPause;
}

void ThunderBorg::drive(const WheelPower& power) {
  trusting([&] {
    if (!std::isfinite(power.left) || !std::isfinite(power.right))
      throw DeviceError("motors: told to drive with a power that is no number");
    const Outputs out = outputs(power);
    if (out.a == 0 && out.b == 0) {
      tell(Command::kAllOff);
    } else {
      set_a(out.a);
      set_b(out.b);
    }
    if (check_b_next_) {
      check_b(out.b);
    } else {
      check_a(out.a);
    }
    check_b_next_ = !check_b_next_;
  });
}

ThunderBorg::Outputs ThunderBorg::outputs(const WheelPower& power) const {
  const int left = thunderborg::motor_power(power.left), right = thunderborg::motor_power(power.right);
  const Outputs out = config_.swap ? Outputs{right, left} : Outputs{left, right};
  return {config_.invert_a ? -out.a : out.a, config_.invert_b ? -out.b : out.b};
}

void ThunderBorg::set_motor(int power, Command forward, Command reverse) {
  tell(power < 0 ? reverse : forward, {static_cast<std::uint8_t>(std::abs(power))});
}

void ThunderBorg::check_a(int power) {
  check_motor(power, Command::kGetA, [&] { set_a(power); });
}

void ThunderBorg::check_b(int power) {
  check_motor(power, Command::kGetB, [&] { set_b(power); });
}

/// Just after the motor was told: later, the failsafe may have switched it off.
template <class SetMotor>
void ThunderBorg::check_motor(int power, Command question, SetMotor&& set_again) {
  for (int tried = 0; tried < I2cDevice::kTries; ++tried) {
    if (tried > 0) set_again();
    if (ask(question, &thunderborg::decode_motor) == power) return;
    board_.count("readback");
  }
  throw DeviceError("motors: the board does not do what it is told: look at its wires and supply");
}

MotorState ThunderBorg::read() {
  return trusting([&] {
    switch (next_question_++ % 3) {
      case 0:
        check_failsafe();
        break;
      case 1:
        read_fault(Command::kGetFaultA);
        break;
      default:
        read_fault(Command::kGetFaultB);
    }
    show_light();
    const double battery_v = ask(Command::kGetBattery, &thunderborg::decode_battery_v);
    return MotorState{battery_v, config_.swap ? fault_b_ : fault_a_, config_.swap ? fault_a_ : fault_b_,
                      true};
  });
}

/// A board that lost its failsafe was without power for a moment and knows nothing any more.
void ThunderBorg::check_failsafe() {
  if (ask(Command::kGetFailsafe, &thunderborg::decode_flag)) return;
  board_.count("failsafe-off");
  begin();
}

void ThunderBorg::read_fault(Command question) {
  (question == Command::kGetFaultA ? fault_a_ : fault_b_) = ask(question, &thunderborg::decode_flag);
}

void ThunderBorg::set_light(const LightColor& color) {
  light_ = static_cast<std::uint32_t>(color.red << 16 | color.green << 8 | color.blue);
}

void ThunderBorg::show(Motion motion) { set_light(color_of(motion)); }

void ThunderBorg::show_light() {
  const std::uint32_t light = light_;
  if (light == light_shown_) return;
  if (light_shown_ == kBatteryLight) tell(Command::kShowBattery, {0});
  const auto part = [&](int shift) { return static_cast<std::uint8_t>(light >> shift & 0xff); };
  tell(Command::kSetLights, {part(16), part(8), part(0)});
  light_shown_ = light;
}

ThunderBorgReport ThunderBorg::report() {
  return trusting([&] {
    ThunderBorgReport report;
    report.battery_v = ask(Command::kGetBattery, &thunderborg::decode_battery_v);
    report.failsafe_on = ask(Command::kGetFailsafe, &thunderborg::decode_flag);
    report.fault_a = ask(Command::kGetFaultA, &thunderborg::decode_flag);
    report.fault_b = ask(Command::kGetFaultB, &thunderborg::decode_flag);
    report.power_a = ask(Command::kGetA, &thunderborg::decode_motor);
    report.power_b = ask(Command::kGetB, &thunderborg::decode_motor);
    return report;
  });
}

void ThunderBorg::tell(Command command, std::initializer_list<std::uint8_t> values) {
  const int error = board_.write(static_cast<std::uint8_t>(command), {values.begin(), values.size()});
  if (error) throw board_.failure(error);
}

/// Asks again when what comes is not the answer, as after a transfer that was disturbed.
template <class T>
T ThunderBorg::ask(Command question, std::optional<T> (*decode)(const thunderborg::Answer&)) {
  for (int tried = 0; tried < I2cDevice::kTries; ++tried) {
    thunderborg::Answer answer{};
    if (const int error = board_.ask(static_cast<std::uint8_t>(question), answer))
      throw board_.failure(error);
    if (thunderborg::belongs_to(answer, question)) {
      if (const std::optional<T> value = decode(answer)) return *value;
    }
    board_.count("wrong-answer");
  }
  throw DeviceError("motors: the board answers nonsense: look at its wires, and what else uses its bus");
}

}  // namespace dynslam
