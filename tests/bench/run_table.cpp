// SPDX-License-Identifier: MIT
#include "bench/run_table.h"

#include <algorithm>
#include <limits>

namespace dynslam::bench {

void RunTable::add(const std::string& benchmark, const std::string& counter, double value) {
  values_[benchmark][counter].push_back(value);
}

double RunTable::value(std::string_view benchmark, std::string_view counter) const {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const auto counters = values_.find(benchmark);
  if (counters == values_.end()) return kNone;
  const auto values = counters->second.find(counter);
  if (values == counters->second.end()) return kNone;
  std::vector<double> sorted = values->second;
  std::sort(sorted.begin(), sorted.end());
  return sorted[sorted.size() / 2];
}

std::vector<std::string> RunTable::cases_of(std::string_view what) const {
  const std::string start = std::string(what) + "/";
  std::vector<std::string> cases;
  for (const auto& [name, counters] : values_) {
    if (name.starts_with(start)) cases.push_back(name.substr(start.size()));
  }
  return cases;
}

}  // namespace dynslam::bench
