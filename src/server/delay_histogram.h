// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "base/time.h"

namespace dynslam {

/// How often something took how long. Not thread-safe.
class DelayHistogram {
 public:
  void add(Duration delay) {
    for (std::size_t i = 0; i < kBounds_ms.size(); ++i)
      if (delay <= std::chrono::milliseconds(kBounds_ms[i])) ++counts_[i];
    ++count_;
    sum_s_ += to_seconds(delay);
  }
  std::uint64_t count() const { return count_; }
  double sum_s() const { return sum_s_; }

  /// As Prometheus reads it.
  std::string text(std::string_view name, std::string_view help) const;

 private:
  static constexpr std::array<int, 12> kBounds_ms = {1, 2, 5, 10, 15, 20, 25, 30, 40, 60, 100, 200};
  std::array<std::uint64_t, kBounds_ms.size()> counts_{};
  std::uint64_t count_ = 0;
  double sum_s_ = 0.0;
};

}  // namespace dynslam
