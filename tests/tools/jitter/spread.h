// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

namespace dynslam::jitter {

struct Spread {
  double min = 0.0, median = 0.0, mean = 0.0, max = 0.0;
};

/// REQUIRES: !values.empty().
inline Spread spread_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return {values.front(), std::midpoint(values[(n - 1) / 2], values[n / 2]),
          std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(n), values.back()};
}

/// How far the worst may lie from the median. Either is enough: a factor says nothing of errors near zero.
struct Tolerance {
  double factor = 1.5;
  double margin_m = 0.05;
};

/// Whether the worst is not worse than it may be.
inline bool is_narrow(const Spread& spread_m, const Tolerance& tolerance) {
  return spread_m.max <= tolerance.factor * spread_m.median ||
         spread_m.max <= spread_m.median + tolerance.margin_m;
}

}  // namespace dynslam::jitter
