// SPDX-License-Identifier: MIT
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <utility>

#include "pipe/clock.h"

namespace dynslam {

/// A pipe that keeps values in order, up to `capacity` of them: a full one drops its oldest and counts it, so
/// that a producer never waits. Any number of writers and readers.
template <class T>
class BoundedQueue {
 public:
  explicit BoundedQueue(std::size_t capacity) : capacity_(capacity) {}

  /// False when an older value had to go. After close() nothing is taken any more.
  bool push(T value) {
    bool kept_all = true;
    {
      const std::lock_guard lock(mutex_);
      if (closed_) return true;
      values_.push_back(std::move(value));
      if (values_.size() > capacity_) {
        values_.pop_front();
        ++dropped_;
        kept_all = false;
      }
    }
    changed_.notify_one();
    return kept_all;
  }

  /// The oldest; nothing when there is none.
  std::optional<T> try_pop() {
    const std::lock_guard lock(mutex_);
    return take();
  }

  /// The same, waiting for one until `until` at most, or until close().
  std::optional<T> pop(Clock::SteadyTime until) {
    std::unique_lock lock(mutex_);
    changed_.wait_until(lock, until, [&] { return !values_.empty() || closed_; });
    return take();
  }

  /// Nobody waits any more; what is in the pipe can still be taken.
  void close() {
    {
      const std::lock_guard lock(mutex_);
      closed_ = true;
    }
    changed_.notify_all();
  }

  bool closed() const {
    const std::lock_guard lock(mutex_);
    return closed_;
  }
  std::size_t size() const {
    const std::lock_guard lock(mutex_);
    return values_.size();
  }
  std::uint64_t dropped() const {
    const std::lock_guard lock(mutex_);
    return dropped_;
  }

 private:
  std::optional<T> take() {
    if (values_.empty()) return std::nullopt;
    std::optional<T> value(std::move(values_.front()));
    values_.pop_front();
    return value;
  }

  const std::size_t capacity_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<T> values_;
  std::uint64_t dropped_ = 0;
  bool closed_ = false;
};

}  // namespace dynslam
