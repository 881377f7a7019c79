// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <set>
#include <string>
#include <string_view>

#include "base/counters.h"

namespace dynslam {

/// Counts what was skipped by a name out of the file, as PREFIX.NAME. A file may hold any number of names
/// with any bytes in them; so only the first 32 are kept (the rest is PREFIX.other), cut to 80 characters,
/// unprintable ones as `?`.
class SkipCounts {
 public:
  SkipCounts(Counters& counters, std::string_view prefix) : counters_(counters), prefix_(prefix) {}

  void add(std::string_view name) {
    std::string clean(name.substr(0, kMaxLength));
    std::replace_if(
        clean.begin(), clean.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
    if (!names_.contains(clean)) {
      if (names_.size() >= kMaxNames) clean = "other";
      names_.insert(clean);
    }
    counters_.add(prefix_ + '.' + clean);
  }

 private:
  static constexpr std::size_t kMaxNames = 32;
  static constexpr std::size_t kMaxLength = 80;

  Counters& counters_;
  std::string prefix_;
  std::set<std::string> names_;
};

}  // namespace dynslam
