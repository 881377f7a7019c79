// SPDX-License-Identifier: MIT
#pragma once

#include <condition_variable>
#include <mutex>
#include <string>

#include "pipe/clock.h"

namespace dynslam {

/// Asks all threads of the robot to end, and lets them wait for that. The first reason given is kept. Any
/// thread.
class StopSignal {
 public:
  /// An empty reason: all is well, somebody asked.
  void request(const std::string& trouble = {}) {
    {
      const std::lock_guard lock(mutex_);
      if (!requested_) trouble_ = trouble;
      requested_ = true;
    }
    changed_.notify_all();
  }
  bool requested() const {
    const std::lock_guard lock(mutex_);
    return requested_;
  }
  /// What went wrong; empty when nothing did.
  std::string trouble() const {
    const std::lock_guard lock(mutex_);
    return trouble_;
  }
  /// Waits until `until` at most; returns whether to stop.
  bool wait(Clock::SteadyTime until) const {
    std::unique_lock lock(mutex_);
    return changed_.wait_until(lock, until, [&] { return requested_; });
  }

 private:
  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  bool requested_ = false;
  std::string trouble_;
};

}  // namespace dynslam
