// SPDX-License-Identifier: MIT
#include "drivers/gpio/chips.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <filesystem>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

namespace dynslam {
namespace {

constexpr std::string_view kFolder = "/dev";
constexpr std::string_view kPrefix = "gpiochip";
/// Of Raspberry Pi Zero to 3, 4 and 5. The number of the chip differs from kernel to kernel.
constexpr std::array<std::string_view, 3> kHeaderLabels = {"pinctrl-bcm2835", "pinctrl-bcm2711",
                                                           "pinctrl-rp1"};

std::string reason(int error) { return std::generic_category().message(error); }

/// "gpiochip12" is 12.
std::optional<unsigned> chip_number(std::string_view name) {
  if (!name.starts_with(kPrefix)) return std::nullopt;
  name.remove_prefix(kPrefix.size());
  unsigned number = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  if (error != std::errc() || end != name.data() + name.size()) return std::nullopt;
  return number;
}

std::string_view name_of(const ChipInfo& chip) {
  return std::string_view(chip.path).substr(chip.path.rfind('/') + 1);
}

bool is_wanted(const ChipInfo& chip, const std::string& wanted) {
  if (wanted == "auto")
    return std::find(kHeaderLabels.begin(), kHeaderLabels.end(), chip.label) != kHeaderLabels.end();
  return wanted == chip.path || wanted == name_of(chip) || wanted == chip.label;
}

/// "gpiochip0 (pinctrl-bcm2835), gpiochip1 (raspberrypi-exp-gpio)"
std::string shown(std::span<const ChipInfo> chips) {
  std::string text;
  for (const ChipInfo& chip : chips) {
    text += text.empty() ? "" : ", ";
    text += name_of(chip);
    text += " (" + (chip.error == 0 ? chip.label : reason(chip.error)) + ")";
  }
  return text;
}

}  // namespace

std::vector<ChipInfo> list_chips() {
  std::vector<std::pair<unsigned, std::string>> found;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(kFolder, error)) {
    const std::string name = entry.path().filename();
    if (const auto number = chip_number(name)) found.emplace_back(*number, entry.path());
  }
  std::sort(found.begin(), found.end());
  std::vector<ChipInfo> chips;
  for (const auto& [number, path] : found) chips.push_back(ask_chip(path));
  return chips;
}

std::string choose_chip(std::span<const ChipInfo> chips, const std::string& wanted, const std::string& who) {
  if (chips.empty()) throw DeviceError(who + ": there is no /dev/gpiochip*: has this computer any GPIO?");
  const auto it =
      std::find_if(chips.begin(), chips.end(), [&](const auto& c) { return is_wanted(c, wanted); });
  if (it != chips.end()) return it->path;
  // One that may not be asked has no label to be known by.
  const auto refused = std::find_if(chips.begin(), chips.end(), [](const auto& c) { return c.error != 0; });
  if (refused != chips.end()) throw chip_error(who, refused->path, refused->error);
  const std::string what =
      wanted == "auto" ? "no chip is that of a Raspberry Pi's header" : "no chip is called '" + wanted + "'";
  throw DeviceError(who + ": " + what + ": set gpio.chip to one of " + shown(chips));
}

DeviceError chip_error(const std::string& who, const std::string& path, int error) {
  std::string text = who + ": " + path + ": " + reason(error);
  if (error == EACCES || error == EPERM) text += ": is the user in group gpio?";
  if (error == ENOENT || error == ENODEV) text += ": was it unplugged?";
  return DeviceError(text);
}

DeviceError line_error(const std::string& who, const std::string& path, unsigned offset, int error) {
  std::string text = who + ": line " + std::to_string(offset) + " of " + path + ": ";
  if (error == EBUSY) {
    text += "in use by another program or by a kernel driver: gpioinfo says by which";
  } else if (error == EINVAL) {
    text += "the chip has no such line, or cannot do with it what is asked";
  } else {
    text += reason(error);
  }
  return DeviceError(text);
}

}  // namespace dynslam
