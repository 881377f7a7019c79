// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "io/recording.h"

namespace dynslam::jitter {

/// A recording of what a test wants it to hold.
class MadeRecording final : public Recording {
 public:
  explicit MadeRecording(std::vector<Record> records, std::optional<std::string> damage = {})
      : records_(std::move(records)), damage_(std::move(damage)) {}

  std::optional<Record> next() override {
    if (read_ == records_.size()) return std::nullopt;
    return records_[read_++];
  }
  double progress() const override {
    return static_cast<double>(read_) / static_cast<double>(records_.size());
  }
  const std::optional<std::string>& damage() const override { return damage_; }
  const Counters& counters() const override { return counters_; }

 private:
  std::vector<Record> records_;
  std::size_t read_ = 0;
  std::optional<std::string> damage_;
  Counters counters_;
};

}  // namespace dynslam::jitter
