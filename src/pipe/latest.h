// SPDX-License-Identifier: MIT
#pragma once

#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <utility>

#include "pipe/clock.h"

namespace dynslam {

/// A pipe that holds one immutable value, the newest: who reads slowly skips some. Any number of writers and
/// readers; nobody waits longer than it takes to copy a pointer, but in wait().
///
/// Invariants: version() counts the values put; a value is never changed once put.
template <class T>
class Latest {
 public:
  struct Item {
    std::shared_ptr<const T> value;  ///< null when none was put yet
    std::uint64_t version = 0;
  };

  void put(T value) { put(std::make_shared<const T>(std::move(value))); }
  void put(std::shared_ptr<const T> value) {
    {
      const std::lock_guard lock(mutex_);
      item_ = {std::move(value), item_.version + 1};
    }
    changed_.notify_all();
  }

  Item get() const {
    const std::lock_guard lock(mutex_);
    return item_;
  }

  /// Waits for a value newer than `version`, until `until` at most, or until woken by close(). Returns what
  /// there is then.
  Item wait(std::uint64_t version, Clock::SteadyTime until) const {
    std::unique_lock lock(mutex_);
    changed_.wait_until(lock, until, [&] { return item_.version > version || closed_; });
    return item_;
  }

  /// Nobody waits any more.
  void close() {
    {
      const std::lock_guard lock(mutex_);
      closed_ = true;
    }
    changed_.notify_all();
  }

 private:
  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  Item item_;
  bool closed_ = false;
};

}  // namespace dynslam
