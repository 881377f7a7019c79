// SPDX-License-Identifier: MIT
#include "drivers/gpio/gpio_pins.h"

#include <utility>

#include "drivers/gpio/chips.h"

namespace dynslam {
namespace {

using std::chrono::milliseconds;

constexpr Duration kEStopRelease = milliseconds(50);
constexpr Duration kPause = milliseconds(500);
/// Kernels before 5.7 stamp by the wall clock, which is far from ours.
constexpr Duration kOldestEdge = std::chrono::seconds(10);

Pull pull_of(const std::string& word) {
  if (word == "up") return Pull::kUp;
  return word == "down" ? Pull::kDown : Pull::kNone;
}

}  // namespace

GpioPins::GpioPins(const GpioConfig& config, const Clock& clock)
    : GpioPins(config, clock, [chip = config.chip](std::span<const LineUse> uses) {
        return open_inputs(find_chip(chip, "pins"), uses, "pins");
      }) {}

GpioPins::GpioPins(const GpioConfig& config, const Clock& clock, OpenInputs open)
    : clock_(clock),
      open_(std::move(open)),
      has_estop_(config.estop_line >= 0),
      has_bumpers_(!config.bumper_lines.empty()) {
  const Pull pull = pull_of(config.pull);
  if (has_estop_) {
    uses_.push_back({static_cast<unsigned>(config.estop_line), config.estop_active_low, pull});
    fresh_.emplace_back(Duration(0), kEStopRelease);
  }
  const Duration bounce = from_seconds(config.bumper_debounce_s);
  for (const std::string& line : config.bumper_lines) {
    uses_.push_back({GpioConfig::line_number(line).value(), config.bumper_active_low, pull});
    fresh_.emplace_back(bounce, bounce);
  }
  levels_ = std::make_unique<bool[]>(uses_.size());
}

PinState GpioPins::read() {
  if (!lines_ && clock_.now() < ask_again_) throw DeviceError(trouble_);
  try {
    if (!lines_) open();
    take_edges();
    take_levels();
    return state();
  } catch (const DeviceError& e) {
    lines_.reset();
    trouble_ = e.what();
    ask_again_ = clock_.now() + kPause;
    throw;
  }
}

void GpioPins::open() {
  lines_ = open_(uses_);
  switches_ = fresh_;
  take_levels();
}

/// A switch that bounces without end is read by its level.
void GpioPins::take_edges() {
  const std::size_t count = lines_->take_edges(edges_, {});
  for (std::size_t i = 0; i < count; ++i)
    switches_.at(edges_[i].index).update(time_of(edges_[i].at), edges_[i].active);
}

void GpioPins::take_levels() {
  lines_->read({levels_.get(), uses_.size()});
  const Time now = clock_.now();
  for (std::size_t i = 0; i < uses_.size(); ++i) switches_[i].update(now, levels_[i]);
}

Time GpioPins::time_of(Clock::SteadyTime at) const {
  const Duration age = std::chrono::steady_clock::now() - at;
  return age < Duration(0) || age > kOldestEdge ? clock_.now() : clock_.now() - age;
}

PinState GpioPins::state() {
  PinState state;
  if (has_bumpers_) state.bumper_pressed = false;
  for (std::size_t i = 0; i < switches_.size(); ++i) {
    if (!switches_[i].was_on()) continue;
    if (has_estop_ && i == 0) {
      state.estop_pressed = true;
    } else {
      state.bumper_pressed = true;
    }
  }
  return state;
}

}  // namespace dynslam
