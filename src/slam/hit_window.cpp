// SPDX-License-Identifier: MIT
#include "slam/hit_window.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace dynslam {

/// Room for chunks of `side` cells, and nothing wanted yet.
void HitWindow::shape(int chunks_wide, int chunks_high, int side) {
  chunks_wide_ = chunks_wide;
  stride_ = chunks_wide * side;
  height_ = chunks_high * side;
  wanted_.assign(static_cast<std::size_t>(chunks_wide) * static_cast<std::size_t>(chunks_high), 0);
  const std::size_t cells = static_cast<std::size_t>(stride_) * static_cast<std::size_t>(height_);
  if (cells > capacity_) {
    capacity_ = cells + cells / 2;
    data_ = std::make_unique<std::uint8_t[]>(capacity_);
  }
}

void HitWindow::load(const ChunkedGrid& grid, std::span<const MatchPoint> points, const Pose2& grid_T_robot, float reach,
                     float turn_rad, float gain, std::uint8_t unknown) {
  const auto c = static_cast<float>(std::cos(grid_T_robot.yaw)), s = static_cast<float>(std::sin(grid_T_robot.yaw));
  const auto place = [&](const MatchPoint& p) {
    return std::pair{grid_T_robot.x + (c * p.x - s * p.y), grid_T_robot.y + (s * p.x + c * p.y)};
  };
  double min_x = grid_T_robot.x, max_x = min_x, min_y = grid_T_robot.y, max_y = min_y;
  float farthest2 = 0;
  for (const MatchPoint& p : points) {
    const auto [x, y] = place(p);
    min_x = std::min(min_x, x), max_x = std::max(max_x, x);
    min_y = std::min(min_y, y), max_y = std::max(max_y, y);
    farthest2 = std::max(farthest2, p.x * p.x + p.y * p.y);
  }
  const double margin = reach + turn_rad * std::sqrt(farthest2) + kLanes + 4;
  const auto chunk = [](double cells) { return static_cast<std::int32_t>(std::floor(cells)) >> kChunkBits; };
  const ChunkBox box{{chunk(min_x - margin), chunk(min_y - margin)}, {chunk(max_x + margin), chunk(max_y + margin)}};
  shape(box.width(), box.height(), kChunkSide);
  first_ = first_cell(box.min);

  for (const MatchPoint& p : points) {
    const auto [x, y] = place(p);
    const double around = reach + turn_rad * std::sqrt(p.x * p.x + p.y * p.y) + 4;
    const int left = chunk(x - around) - box.min.x, right = chunk(x + around + kLanes) - box.min.x;
    const int low = chunk(y - around) - box.min.y, high = chunk(y + around) - box.min.y;
    for (int cy = low; cy <= high; ++cy) {
      for (int cx = left; cx <= right; ++cx) wanted_[static_cast<std::size_t>(cy * chunks_wide_ + cx)] = 1;
    }
  }
  const int gain_256 = static_cast<int>(gain * 256);
  for (int cy = 0; cy < box.height(); ++cy) {
    for (int cx = 0; cx < box.width(); ++cx) {
      if (!wanted_[static_cast<std::size_t>(cy * chunks_wide_ + cx)]) continue;
      const Chunk* from = grid.find({box.min.x + cx, box.min.y + cy});
      std::uint8_t* to = data_.get() + static_cast<std::ptrdiff_t>(cy * kChunkSide) * stride_ + cx * kChunkSide;
      for (int r = 0; r < kChunkSide; ++r, to += stride_) {
        if (!from) {
          std::memset(to, unknown, kChunkSide);
        } else {
          for (int i = 0; i < kChunkSide; ++i) {
            const int hit = std::min(255, (from->hit[r][i] * gain_256) >> 8);
            to[i] = from->hit[r][i] == 0 && from->miss[r][i] == 0 ? unknown : static_cast<std::uint8_t>(hit);
          }
        }
      }
    }
  }
}

void HitWindow::pool(const HitWindow& fine, int factor) {
  const int side = kChunkSide / factor;
  shape(fine.chunks_wide_, fine.height_ / kChunkSide, side);
  wanted_ = fine.wanted_;
  first_ = {0, 0};
  for (int y = 0; y < height_; ++y) {
    for (int k = 0; k < chunks_wide_; ++k) {
      std::uint8_t* to = data_.get() + static_cast<std::ptrdiff_t>(y) * stride_ + k * side;
      if (!wanted_[static_cast<std::size_t>(y / side * chunks_wide_ + k)]) {
        std::memset(to, 0, static_cast<std::size_t>(side));
        continue;
      }
      std::uint8_t best[kChunkSide] = {};
      const std::uint8_t* from = fine.data() + static_cast<std::ptrdiff_t>(y * factor) * fine.stride() + k * kChunkSide;
      for (int r = 0; r < factor; ++r, from += fine.stride()) {
        for (int i = 0; i < kChunkSide; ++i) best[i] = std::max(best[i], from[i]);
      }
      for (int i = 0; i < side; ++i) to[i] = *std::max_element(best + i * factor, best + (i + 1) * factor);
    }
  }
}

}  // namespace dynslam
