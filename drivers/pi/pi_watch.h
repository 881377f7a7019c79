// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace dynslam {

/// What a Raspberry Pi's firmware says of its supply and its speed, now and since it was started. The bits
/// are those of `vcgencmd get_throttled`.
class PiFlags {
 public:
  explicit PiFlags(std::uint32_t bits) : bits_(bits) {}

  /// The supply is under 4.63 V.
  bool under_voltage() const { return bit(0); }
  bool frequency_capped() const { return bit(1); }
  bool throttled() const { return bit(2); }
  /// A first limit of the temperature; 60 degrees on a 3B+.
  bool soft_temperature_limit() const { return bit(3); }
  bool had_under_voltage() const { return bit(0) || bit(16); }
  bool was_slowed() const { return (bits_ & 0xe000eU) != 0; }
  std::uint32_t bits() const { return bits_; }

 private:
  bool bit(unsigned n) const { return ((bits_ >> n) & 1U) != 0; }
  std::uint32_t bits_;
};

/// How the computer itself is doing. What it does not tell is not there.
struct PiState {
  std::optional<PiFlags> flags = {};
  std::optional<bool> under_voltage = {};  ///< now
  std::optional<double> temperature_c = {};

  /// What is wrong now, or was since the start, and what to do about it, each in one line, the worst first.
  std::vector<std::string> advice() const;
};

/// The firmware's flags as the kernel's file holds them: hexadecimal, with or without 0x. Nothing for what is
/// none.
std::optional<PiFlags> parse_flags(std::string_view text);
/// Thousandths of a degree in the kernel's file. Nothing for what no computer has.
std::optional<double> parse_temperature_c(std::string_view text);

/// Reads the state of the computer from the kernel's files, wherever they are on this one; other computers
/// have none or some of them, which is no error. One thread; a reading asks the firmware, which takes up to
/// some milliseconds: once a second is enough, and not in the control's thread.
class PiWatch {
 public:
  /// `root` is where /sys is.
  explicit PiWatch(std::filesystem::path root = "/");
  PiState read() const;
  /// "Raspberry Pi Zero 2 W Rev 1.0"; empty when the computer does not say.
  std::string model() const;

 private:
  std::filesystem::path root_;
  std::filesystem::path flags_, alarm_, temperature_;  ///< empty: not on this computer
};

}  // namespace dynslam
