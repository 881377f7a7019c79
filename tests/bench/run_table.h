// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace dynslam::bench {

/// The counters of all runs, by benchmark. With repetitions each has several values.
class RunTable {
 public:
  void add(const std::string& benchmark, const std::string& counter, double value);
  /// The median of the repetitions; NaN when the benchmark did not run.
  double value(std::string_view benchmark, std::string_view counter) const;
  /// The rest of the names of benchmarks that begin with `what` and a slash.
  std::vector<std::string> cases_of(std::string_view what) const;

 private:
  std::map<std::string, std::map<std::string, std::vector<double>, std::less<>>, std::less<>> values_;
};

}  // namespace dynslam::bench
