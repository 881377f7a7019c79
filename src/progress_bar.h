// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace dynslam {

/// One line of text for a share of work done: a bar, the rate and the time left. `elapsed_s` > 0.
std::string progress_line(double share, std::uint64_t scans, double elapsed_s);

/// Keeps that line at the bottom of a terminal: on stderr, ten times a second at the most. Does nothing where
/// stderr is no terminal.
class ProgressBar {
 public:
  explicit ProgressBar(bool wanted);
  ~ProgressBar() { clear(); }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void show(double share, std::uint64_t scans);
  /// Takes the line away again.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;
  bool on_;
  bool shown_ = false;
  Clock::time_point begun_ = Clock::now();
  Clock::time_point last_ = begun_;
};

}  // namespace dynslam
