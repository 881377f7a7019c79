// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>

#include "device/device_error.h"
#include "pipe/clock.h"

namespace dynslam {

/// What holds an input while its wire is open.
enum class Pull { kNone, kUp, kDown };

/// A line of a chip and how it is wired.
struct LineUse {
  unsigned offset = 0;      ///< on the chip; on a Raspberry Pi the GPIO's number
  bool active_low = false;  ///< active while the wire is low
  Pull pull = Pull::kNone;
};

/// An input that changed.
struct LineEdge {
  std::size_t index = 0;  ///< of the line, in the order they were asked for
  bool active = false;    ///< from now on
  Clock::SteadyTime at;   ///< by the kernel's clock
};

/// Inputs that this program holds; nobody else can have them. One thread. All throw DeviceError.
class InputLines {
 public:
  virtual ~InputLines() = default;
  /// Whether each is active now, in the order they were asked for. REQUIRES: as many as there are lines.
  virtual void read(std::span<bool> active) = 0;
  /// Takes what changed since, oldest first, as much as there is room for, and returns how much. Waits for
  /// the first until `until`; a time that has passed: not at all. The kernel keeps 16 edges a line and
  /// drops further ones.
  virtual std::size_t take_edges(std::span<LineEdge> edges, Clock::SteadyTime until) = 0;
};

/// An output that this program holds. What it does after that is for a resistor to say. One thread.
class OutputLine {
 public:
  virtual ~OutputLine() = default;
  /// Throws DeviceError.
  virtual void set(bool active) = 0;
};

/// A chip as it presents itself.
struct ChipInfo {
  std::string path;        ///< "/dev/gpiochip0"
  std::string label = {};  ///< "pinctrl-bcm2835"
  std::size_t lines = 0;
  int error = 0;  ///< errno when it could not be asked
};

// The layer over libgpiod; one source for its version 1, one for 2. `who` is what the lines are for, as in
// "pins": others who want them see it, and so does who reads the error.

ChipInfo ask_chip(const std::string& path);
/// Throws DeviceError. REQUIRES: 64 lines at most, each once.
std::unique_ptr<InputLines> open_inputs(const std::string& chip_path, std::span<const LineUse> uses,
                                        const std::string& who);
/// Throws DeviceError. The line is `active` from the beginning.
std::unique_ptr<OutputLine> open_output(const std::string& chip_path, const LineUse& use, bool active,
                                        const std::string& who);

}  // namespace dynslam
