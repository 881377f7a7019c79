// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <utility>

#include "base/time.h"

namespace dynslam {

/// What a simulated device has measured and nobody has fetched yet; full, it loses the oldest, as a serial
/// port's buffer does.
template <class T>
class Outbox {
 public:
  explicit Outbox(std::size_t capacity) : capacity_(capacity) {}

  /// `due`: when it will have come through the wire.
  void put(Time due, T value) {
    if (samples_.size() == capacity_) {
      samples_.pop_front();
      ++lost_;
    }
    samples_.emplace_back(due, std::move(value));
  }
  /// The oldest sample, if it was due by then.
  std::optional<T> take(Time due_by) {
    if (samples_.empty() || samples_.front().first > due_by) return std::nullopt;
    std::optional<T> value(std::move(samples_.front().second));
    samples_.pop_front();
    return value;
  }
  std::optional<Time> next_due() const {
    if (samples_.empty()) return std::nullopt;
    return samples_.front().first;
  }
  void clear() {
    lost_ += samples_.size();
    samples_.clear();
  }
  std::uint64_t lost() const { return lost_; }

 private:
  std::size_t capacity_;
  std::deque<std::pair<Time, T>> samples_;
  std::uint64_t lost_ = 0;
};

}  // namespace dynslam
