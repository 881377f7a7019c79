// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <ctime>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace dynslam {

/// What the machine believes to be the time of day, to the second. It jumps by years when a machine that
/// keeps no time while it is off finds the internet; nothing may wait by it.
using WallTime = std::chrono::sys_seconds;

inline WallTime wall_now() {
  return std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
}

/// In UTC, by default as it stands in names of files: "20261126-144501". `format` as of strftime.
inline std::string utc_text(WallTime time, const char* format = "%Y%m%d-%H%M%S") {
  const std::time_t seconds = time.time_since_epoch().count();
  std::tm parts{};
  gmtime_r(&seconds, &parts);
  std::array<char, 40> text{};
  return {text.data(), std::strftime(text.data(), text.size(), format, &parts)};
}

/// The time that stands in a name, as utc_text() put it there.
inline std::optional<WallTime> time_in_name(std::string_view name) {
  using namespace std::chrono;
  constexpr std::string_view kShape = "00000000-000000";
  const auto fits = [](char c, char shape) { return shape == '0' ? c >= '0' && c <= '9' : c == shape; };
  const auto at = std::search(name.begin(), name.end(), kShape.begin(), kShape.end(), fits);
  if (at == name.end()) return std::nullopt;
  const auto number = [at](std::size_t first, std::size_t digits) {
    unsigned n = 0;
    for (std::size_t i = first; i < first + digits; ++i) n = 10 * n + static_cast<unsigned>(at[i] - '0');
    return n;
  };
  const year_month_day date{year(static_cast<int>(number(0, 4))), month(number(4, 2)), day(number(6, 2))};
  const unsigned hour = number(9, 2), minute = number(11, 2), second = number(13, 2);
  if (!date.ok() || hour > 23 || minute > 59 || second > 59) return std::nullopt;
  return sys_days(date) + hours(hour) + minutes(minute) + seconds(second);
}

/// The time to name something new by: now, or a second after the newest of the names where the clock is not
/// beyond that. So names sort as they were given, whatever the clock does.
inline WallTime time_after(const std::vector<std::string>& names, WallTime now) {
  for (const std::string& name : names)
    if (const auto older = time_in_name(name)) now = std::max(now, *older + std::chrono::seconds(1));
  return now;
}

}  // namespace dynslam
