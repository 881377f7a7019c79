// SPDX-License-Identifier: MIT
#include "drivers/pi/pi_watch.h"

#include <charconv>
#include <fstream>
#include <system_error>
#include <utility>

namespace dynslam {
namespace {

namespace fs = std::filesystem;

constexpr double kHot_c = 80.0;  ///< the firmware throttles from here
constexpr double kWarm_c = 70.0;

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank(" \t\r\n\0", 5);
  const std::size_t begin = text.find_first_not_of(kBlank);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlank) + 1 - begin);
}

template <class T>
std::optional<T> parse(std::string_view text, int base) {
  text = trimmed(text);
  if (base == 16 && text.starts_with("0x")) text.remove_prefix(2);
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, base);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// The beginning of a file, which may lie; empty when it cannot be read.
std::string content(const fs::path& file) {
  if (file.empty()) return {};
  std::ifstream in(file, std::ios::binary);
  std::string text(256, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  return text;
}

/// The first entry of a folder that `file_of` finds a file in.
template <class FileOf>
fs::path search(const fs::path& folder, FileOf&& file_of) {
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    fs::path file = file_of(it->path());
    std::error_code missing;
    if (!file.empty() && fs::exists(file, missing)) return file;
  }
  return {};
}

/// Where the firmware's device stands in the tree differs from board to board.
fs::path find_flags(const fs::path& root) {
  const fs::path usual = root / "sys/devices/platform/soc/soc:firmware/get_throttled";
  std::error_code error;
  if (fs::exists(usual, error)) return usual;
  return search(root / "sys/bus/platform/devices", [](const fs::path& device) {
    return device.filename().string().ends_with(":firmware") ? device / "get_throttled" : fs::path();
  });
}

fs::path find_alarm(const fs::path& root) {
  return search(root / "sys/class/hwmon", [](const fs::path& device) {
    return trimmed(content(device / "name")) == "rpi_volt" ? device / "in0_lcrit_alarm" : fs::path();
  });
}

}  // namespace

std::optional<PiFlags> parse_flags(std::string_view text) {
  const auto bits = parse<std::uint32_t>(text, 16);
  return bits ? std::optional(PiFlags(*bits)) : std::nullopt;
}

std::optional<double> parse_temperature_c(std::string_view text) {
  const auto thousandths = parse<int>(text, 10);
  if (!thousandths || *thousandths < -50'000 || *thousandths > 150'000) return std::nullopt;
  return *thousandths * 1e-3;
}

std::vector<std::string> PiState::advice() const {
  std::vector<std::string> lines;
  const bool past_drop = flags && flags->had_under_voltage();
  if (under_voltage.value_or(false)) {
    lines.emplace_back(
        "computer: its supply is under 4.63 V: charge the battery, check the 5 V converter and its cable");
  } else if (past_drop) {
    lines.emplace_back(
        "computer: its supply was under 4.63 V since it was started: check the 5 V converter and its cable");
  }
  const bool hot = temperature_c && *temperature_c >= kHot_c;
  const bool slowed = flags && (flags->throttled() || flags->frequency_capped());
  if (hot) {
    lines.emplace_back("computer: 80 degrees or more, it slows itself down: give it air or a heat sink");
  } else if (slowed) {
    lines.emplace_back("computer: it is slowed down by heat or by its supply: mapping may lag");
  } else if (flags && flags->soft_temperature_limit()) {
    lines.emplace_back("computer: warm, it will not run at full speed: give it air or a heat sink");
  } else if (temperature_c && *temperature_c >= kWarm_c) {
    lines.emplace_back("computer: 70 degrees or more, from 80 on it slows itself down: give it air");
  } else if (flags && flags->was_slowed()) {
    lines.emplace_back("computer: it was slowed down since it was started, by heat or by its supply");
  }
  return lines;
}

PiWatch::PiWatch(fs::path root)
    : root_(std::move(root)),
      flags_(find_flags(root_)),
      alarm_(find_alarm(root_)),
      temperature_(root_ / "sys/class/thermal/thermal_zone0/temp") {}

PiState PiWatch::read() const {
  PiState state;
  state.flags = parse_flags(content(flags_));
  state.temperature_c = parse_temperature_c(content(temperature_));
  if (const auto alarm = parse<int>(content(alarm_), 10)) state.under_voltage = *alarm != 0;
  if (state.flags) state.under_voltage = state.flags->under_voltage() || state.under_voltage.value_or(false);
  return state;
}

std::string PiWatch::model() const { return std::string(trimmed(content(root_ / "proc/device-tree/model"))); }

}  // namespace dynslam
