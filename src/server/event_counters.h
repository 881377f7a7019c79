// SPDX-License-Identifier: MIT
#pragma once

#include <mutex>
#include <string_view>

#include "base/counters.h"

namespace dynslam {

/// Counters that all threads of the server share.
class EventCounters {
 public:
  void add(std::string_view name) {
    const std::lock_guard lock(mutex_);
    counters_.add(name);
  }
  Counters get() const {
    const std::lock_guard lock(mutex_);
    return counters_;
  }

 private:
  mutable std::mutex mutex_;
  Counters counters_;
};

}  // namespace dynslam
