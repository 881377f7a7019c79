// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

namespace dynslam {

/// Named counts of the weather: bad packets, skipped topics, scans out of order. Not thread-safe.
class Counters {
 public:
  void add(std::string_view name, std::uint64_t n = 1) {
    const auto it = counts_.find(name);
    if (it != counts_.end()) {
      it->second += n;
    } else {
      counts_.emplace(name, n);
    }
  }
  std::uint64_t operator[](std::string_view name) const {
    const auto it = counts_.find(name);
    return it == counts_.end() ? 0 : it->second;
  }
  auto begin() const { return counts_.begin(); }
  auto end() const { return counts_.end(); }
  bool empty() const { return counts_.empty(); }

 private:
  std::map<std::string, std::uint64_t, std::less<>> counts_;
};

}  // namespace dynslam
