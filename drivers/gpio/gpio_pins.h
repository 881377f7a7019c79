// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "device/pins.h"
#include "drivers/gpio/debounce.h"
#include "drivers/gpio/gpio_config.h"
#include "drivers/gpio/lines.h"

namespace dynslam {

/// E-stop and bumpers on GPIO lines. The first edge of the e-stop counts; it is released once it was so for
/// 50 ms. What was pressed between two calls is told by the second. Levels are read too, as edges get lost.
/// What fails is opened anew after half a second, at the next call.
class GpioPins : public Pins {
 public:
  using OpenInputs = std::function<std::unique_ptr<InputLines>(std::span<const LineUse>)>;

  /// REQUIRES: config.has_pins() and no problem(). `clock` must outlive this and run like life.
  GpioPins(const GpioConfig& config, const Clock& clock);
  /// The same with lines from elsewhere.
  GpioPins(const GpioConfig& config, const Clock& clock, OpenInputs open);

  /// Takes some microseconds; a millisecond when it opens the lines.
  PinState read() override;

 private:
  void open();
  void take_edges();
  void take_levels();
  Time time_of(Clock::SteadyTime at) const;
  PinState state();

  const Clock& clock_;
  OpenInputs open_;
  bool has_estop_, has_bumpers_;
  std::vector<LineUse> uses_;    ///< the e-stop first
  std::vector<Debounce> fresh_;  ///< as they begin
  std::vector<Debounce> switches_;
  std::unique_ptr<bool[]> levels_;
  std::array<LineEdge, 64> edges_;
  std::unique_ptr<InputLines> lines_;
  std::string trouble_;
  Time ask_again_;
};

}  // namespace dynslam
