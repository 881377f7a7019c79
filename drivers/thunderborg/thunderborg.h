// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>

#include "base/counters.h"
#include "device/motors.h"
#include "drivers/i2c/i2c_device.h"
#include "drivers/thunderborg/protocol.h"
#include "drivers/thunderborg/thunderborg_config.h"
#include "pipe/clock.h"

namespace dynslam {

struct LightColor {
  std::uint8_t red = 0, green = 0, blue = 0;
};

/// What the board says when all is asked at once.
struct ThunderBorgReport {
  double battery_v = 0.0;
  bool failsafe_on = false;
  bool fault_a = false, fault_b = false;  ///< may be set until both motors were driven once
  int power_a = 0, power_b = 0;           ///< -255 to 255
};

/// PiBorg's ThunderBorg. It is trusted from when it has told what it is and that its failsafe is on; after
/// anything doubtful the motors are switched off, and it is asked again from the start, 0.2 s later at the
/// earliest: until then each call throws what was wrong. drive() reads back what a motor got, A and B by
/// turns, right after it was told; read() asks for the battery and one of failsafe and faults.
class ThunderBorg : public Motors {
 public:
  /// Switches the motors off if it can. The board need not be there yet.
  ThunderBorg(const ThunderBorgConfig& config, const Clock& clock);
  /// Switches the motors off if it can, and lets the lights show the battery again.
  ~ThunderBorg() override;

  void drive(const WheelPower& power) override;
  MotorState read() override;
  /// Green while the robot may go, yellow when it is slowed down or held, red when it stands, and purple when
  /// a person has to clear an e-stop.
  void show(Motion motion) override;
  std::string about() const override;

  /// What both lights show from the next read() on. Any thread.
  void set_light(const LightColor& color);
  /// Asks for all that it tells: some 7 ms. By the thread of drive(). Throws DeviceError.
  ThunderBorgReport report();
  /// Besides those of I2cDevice: "wrong-answer", "readback", "failsafe-off", "distrusted",
  /// "not-switched-off". Any thread.
  Counters counters() const override { return board_.counters(); }

 private:
  using Command = thunderborg::Command;
  struct Outputs {
    int a = 0, b = 0;
  };

  template <class Act>
  auto trusting(Act&& act);
  void begin();
  void switch_failsafe_on();
  void switch_off();
  void distrust(const std::string& why);

  Outputs outputs(const WheelPower& power) const;
  void set_a(int power) { set_motor(power, Command::kForwardA, Command::kReverseA); }
  void set_b(int power) { set_motor(power, Command::kForwardB, Command::kReverseB); }
  void set_motor(int power, Command forward, Command reverse);
  void check_a(int power);
  void check_b(int power);
  template <class SetMotor>
  void check_motor(int power, Command question, SetMotor&& set_again);
  void check_failsafe();
  void read_fault(Command question);
  void show_light();

  void tell(Command command, std::initializer_list<std::uint8_t> values = {});
  template <class T>
  T ask(Command question, std::optional<T> (*decode)(const thunderborg::Answer&));

  const ThunderBorgConfig config_;
  const Clock& clock_;
  I2cDevice board_;
  bool trusted_ = false;
  std::string trouble_;  ///< while not trusted
  Time ask_again_;
  bool check_b_next_ = false;
  unsigned next_question_ = 0;
  bool fault_a_ = false, fault_b_ = false;
  std::atomic<std::uint32_t> light_{kBatteryLight};
  std::uint32_t light_shown_ = kBatteryLight;

  static constexpr std::uint32_t kBatteryLight = 0xffffffff;  ///< no color: as the board does by itself
};

}  // namespace dynslam
