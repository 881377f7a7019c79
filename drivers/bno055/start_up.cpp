// SPDX-License-Identifier: MIT
#include "drivers/bno055/start_up.h"

#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <thread>

namespace dynslam::bno055 {
namespace {

using std::chrono::milliseconds;

// From the data sheet (BST-BNO055-DS000, 3.3 and table 3-6), with some to spare.
constexpr Duration kBeforeAsking = milliseconds(30);
constexpr Duration kAskEvery = milliseconds(20);
constexpr Duration kResetTakes = milliseconds(1500);  ///< at most
constexpr Duration kAfterReset = milliseconds(100);
constexpr Duration kIntoConfig = milliseconds(25);
constexpr Duration kOutOfConfig = milliseconds(20);
constexpr Duration kCrystalTakes = milliseconds(650);
constexpr Duration kFusionTakes = milliseconds(1000);  ///< at most
constexpr Duration kSettling = milliseconds(50);
constexpr Duration kAfterTrouble = milliseconds(200);

}  // namespace

void wait_until(const Clock& clock, Time t) { std::this_thread::sleep_until(clock.steady(t)); }

StartUp::StartUp(const Bno055Config& config, const Clock& clock, I2cDevice& chip)
    : config_(config), clock_(clock), chip_(chip), due_(clock.now()) {}

bool StartUp::go_on(Time until) {
  while (step_ != Step::kDone) {
    wait_until(clock_, std::min(due_, until));
    if (due_ > until) return false;
    try {
      take_step();
    } catch (const DeviceError&) {
      restart();
      due_ += kAfterTrouble;
      throw;
    }
  }
  return true;
}

void StartUp::restart() {
  wants_profile_ = false;
  next(Step::kIdentify, Duration(0));
}

void StartUp::read_profile_again() {
  wants_profile_ = true;
  next(Step::kLeaveFusion, Duration(0));
}

void StartUp::next(Step step, Duration pause) {
  step_ = step;
  due_ = clock_.now() + pause;
}

void StartUp::take_step() {
  switch (step_) {
    case Step::kIdentify:
      return identify();
    case Step::kReset:
      return reset();
    case Step::kAwaitChip:
      return await_chip();
    case Step::kLeaveFusion:
      return leave_fusion();
    case Step::kSetUp:
      return set_up();
    case Step::kReadProfile:
      return read_profile();
    case Step::kBeginFusion:
      return begin_fusion();
    case Step::kAwaitFusion:
      return await_fusion();
    case Step::kSettle:
      return next(Step::kDone, Duration(0));
    case Step::kDone:
      return;
  }
}

void StartUp::identify() {
  IdentityBytes bytes{};
  must(chip_.write(kPage, std::array<std::uint8_t, 1>{0}));
  must(chip_.read_registers(kIdentityRegister, bytes));
  identity_ = decode_identity(bytes);
  if (identity_.chip != kChip) {
    throw DeviceError("imu: what answers is no BNO055, or its bytes get lost: look at imu.address and the " +
                      std::string("pull-ups of its bus"));
  }
  if (!identity_.is_usual()) chip_.count("odd-identity");
  next(Step::kReset, Duration(0));
}

void StartUp::reset() {
  // It may be gone before it acknowledges.
  if (chip_.write(kTrigger, std::array<std::uint8_t, 1>{kResetBit}, 1) != 0) chip_.count("reset-unheard");
  chip_.count("resets");
  deadline_ = clock_.now() + kResetTakes;
  next(Step::kAwaitChip, kBeforeAsking);
}

void StartUp::await_chip() {
  std::array<std::uint8_t, 1> id{};
  const int error = chip_.read_registers(kIdentityRegister, id, 1);
  if (error == 0 && id[0] == kChip) return next(Step::kLeaveFusion, kAfterReset);
  if (clock_.now() >= deadline_) {
    must(error);
    throw DeviceError("imu: the chip does not come back from its reset: cut its power for a moment");
  }
  next(Step::kAwaitChip, kAskEvery);
}

void StartUp::leave_fusion() {
  must(chip_.write(kMode, std::array<std::uint8_t, 1>{kConfigMode}));
  next(wants_profile_ ? Step::kReadProfile : Step::kSetUp, kIntoConfig);
}

void StartUp::set_up() {
  const AxisMap axes = axis_map(config_.forward, config_.up).value_or(AxisMap{});
  set(kPower, std::array<std::uint8_t, 1>{0});
  set(kUnits, std::array<std::uint8_t, 1>{0});
  set(kAxisMap, std::array<std::uint8_t, 2>{axes.map, axes.signs});
  if (profile_) write_profile();
  if (config_.external_crystal) must(chip_.write(kTrigger, std::array<std::uint8_t, 1>{kCrystalBit}));
  next(Step::kBeginFusion, config_.external_crystal ? kCrystalTakes : Duration(0));
}

/// It takes effect with its last bytes; the chip may round what it reads back.
void StartUp::write_profile() {
  must(chip_.write(kProfile, *profile_));
  Profile kept{};
  must(chip_.read_registers(kProfile, kept));
  if (kept != *profile_) chip_.count("profile-changed");
}

void StartUp::read_profile() {
  Profile found{}, again{};
  must(chip_.read_registers(kProfile, found));
  must(chip_.read_registers(kProfile, again));
  if (found == again && is_possible(found)) profile_ = found;
  wants_profile_ = false;
  next(Step::kBeginFusion, Duration(0));
}

void StartUp::begin_fusion() {
  must(chip_.write(kMode, std::array<std::uint8_t, 1>{mode()}));
  deadline_ = clock_.now() + kFusionTakes;
  next(Step::kAwaitFusion, kOutOfConfig);
}

void StartUp::await_fusion() {
  StatusBytes bytes{};
  must(chip_.read_registers(kStatus, bytes));
  const std::optional<Status> status = decode_status(bytes);
  if (status && status->is_fusing(mode())) {
    ++beginnings_;
    status_ = *status;
    return next(Step::kSettle, kSettling);
  }
  if (clock_.now() < deadline_) return next(Step::kAwaitFusion, kAskEvery);
  if (profile_) chip_.count("profile-refused");
  profile_.reset();  // a bad one keeps the chip from fusing
  throw DeviceError("imu: the chip does not begin to measure: " +
                    std::string(status ? error_words(status->error) : "it answers nonsense"));
}

/// Writes settings until they are there.
void StartUp::set(std::uint8_t reg, std::span<const std::uint8_t> values) {
  std::array<std::uint8_t, 2> kept{};
  const auto there = std::span(kept).first(values.size());
  for (int tried = 0; tried < I2cDevice::kTries; ++tried) {
    must(chip_.write(reg, values));
    must(chip_.read_registers(reg, there));
    if (std::equal(values.begin(), values.end(), there.begin())) return;
    chip_.count("readback");
  }
  throw DeviceError("imu: the chip does not keep its settings: look at its wires and supply");
}

}  // namespace dynslam::bno055
