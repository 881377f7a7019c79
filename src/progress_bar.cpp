// SPDX-License-Identifier: MIT
#include "progress_bar.h"

#include <algorithm>
#include <array>
#include <cstdio>

#include <unistd.h>

namespace dynslam {

std::string progress_line(double share, std::uint64_t scans, double elapsed_s) {
  constexpr int kWidth = 30;
  const double done = std::clamp(share, 0.0, 1.0);
  const int full = static_cast<int>(done * kWidth);
  std::string bar(kWidth, '.');
  std::fill_n(bar.begin(), full, '#');
  std::array<char, 160> line{};
  const double rate = static_cast<double>(scans) / elapsed_s;
  const double left_s = done > 0 ? elapsed_s * (1 - done) / done : 0;
  std::snprintf(line.data(), line.size(), "[%s] %3.0f %%  %llu scans  %.0f/s  %.0f s left", bar.c_str(),
                100 * done, static_cast<unsigned long long>(scans), rate, left_s);
  return line.data();
}

ProgressBar::ProgressBar(bool wanted) : on_(wanted && isatty(STDERR_FILENO) == 1) {}

void ProgressBar::show(double share, std::uint64_t scans) {
  const Clock::time_point now = Clock::now();
  if (!on_ || now - last_ < std::chrono::milliseconds(100)) return;
  last_ = now;
  shown_ = true;
  const double elapsed_s = std::chrono::duration<double>(now - begun_).count();
  std::fprintf(stderr, "\r%s\x1b[K", progress_line(share, scans, elapsed_s).c_str());
}

void ProgressBar::clear() {
  if (shown_) std::fputs("\r\x1b[K", stderr);
  shown_ = false;
}

}  // namespace dynslam
