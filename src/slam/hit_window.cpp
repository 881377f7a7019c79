// SPDX-License-Identifier: MIT
#include "slam/hit_window.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace dynslam {

namespace {

/// Rows that are copied together: a surface needs few of a chunk's 64.
constexpr int kBand = 16;
constexpr int kBandBits = 4;

/// A row of bytes times gain_16 / 16, up to 255.
void copy_scaled(const std::uint8_t* from, std::uint8_t* to, unsigned gain_16) {
  const auto most = static_cast<std::uint8_t>(std::min(255U, 255 * 16 / gain_16));
  for (int i = 0; i < kChunkSide; ++i) {
    const auto hit = static_cast<std::uint16_t>(std::min(from[i], most));
    to[i] = static_cast<std::uint8_t>(static_cast<std::uint16_t>(hit * gain_16) >> 4);
  }
}

void mark_never_seen(const Chunk& chunk, int row, std::uint8_t* to, std::uint8_t value) {
  for (int i = 0; i < kChunkSide; ++i) {
    const bool seen = (chunk.hit[row][i] | chunk.miss[row][i]) != 0;
    to[i] = seen ? to[i] : value;
  }
}

using Bytes = std::uint8_t __attribute__((vector_size(16)));
using Pairs = std::uint16_t __attribute__((vector_size(16)));
using Fours = std::uint32_t __attribute__((vector_size(16)));

Bytes larger(Bytes a, Bytes b) { return a > b ? a : b; }

/// The maxima of the blocks of kPool x kPool bytes that one row of a chunk of the pooled window stands for.
void pool_row(const std::uint8_t* from, std::ptrdiff_t stride, std::uint8_t* to) {
  static_assert(HitWindow::kPool == 4);
  for (int i = 0; i < kChunkSide; i += 16, to += 4) {
    Bytes best{};
    for (int r = 0; r < HitWindow::kPool; ++r) {
      Bytes row;
      std::memcpy(&row, from + r * stride + i, sizeof row);
      best = larger(best, row);
    }
    // Each byte against its neighbour, then each pair against its neighbour: every byte of four becomes their
    // maximum.
    const Pairs pairs = reinterpret_cast<Pairs>(best);
    best = larger(best, reinterpret_cast<Bytes>(pairs << 8 | pairs >> 8));
    const Fours fours = reinterpret_cast<Fours>(best);
    best = larger(best, reinterpret_cast<Bytes>(fours << 16 | fours >> 16));
    for (int k = 0; k < 4; ++k) to[k] = best[4 * k];
  }
}

}  // namespace

/// Room for chunks of `side` cells, and nothing wanted yet.
void HitWindow::shape(int chunks_wide, int chunks_high, int side) {
  chunks_wide_ = chunks_wide;
  stride_ = chunks_wide * side;
  height_ = chunks_high * side;
  wanted_.assign(
      static_cast<std::size_t>(chunks_wide) * static_cast<std::size_t>(chunks_high * kChunkSide / kBand), 0);
  const std::size_t cells = static_cast<std::size_t>(stride_) * static_cast<std::size_t>(height_);
  if (cells > capacity_) {
    capacity_ = cells + cells / 8;
    data_.reset();  // never both at once: a wide search with long rays takes ten megabytes
    data_ = std::make_unique<std::uint8_t[]>(capacity_);
  }
}

void HitWindow::load(const ChunkedGrid& grid, std::span<const MatchPoint> points, const Pose2& grid_T_robot,
                     float reach, float turn_rad, float gain, std::uint8_t unknown) {
  const auto c = static_cast<float>(std::cos(grid_T_robot.yaw)),
             s = static_cast<float>(std::sin(grid_T_robot.yaw));
  float min_x = 0, max_x = 0, min_y = 0, max_y = 0, farthest2 = 0;
  for (const MatchPoint& p : points) {
    const float x = c * p.x - s * p.y, y = s * p.x + c * p.y;
    min_x = std::min(min_x, x), max_x = std::max(max_x, x);
    min_y = std::min(min_y, y), max_y = std::max(max_y, y);
    farthest2 = std::max(farthest2, p.x * p.x + p.y * p.y);
  }
  const double margin = reach + turn_rad * std::sqrt(farthest2) + kLanes + 4;
  const auto chunk = [](double cells) { return static_cast<std::int32_t>(std::floor(cells)) >> kChunkBits; };
  const ChunkBox box{{chunk(grid_T_robot.x + min_x - margin), chunk(grid_T_robot.y + min_y - margin)},
                     {chunk(grid_T_robot.x + max_x + margin), chunk(grid_T_robot.y + max_y + margin)}};
  shape(box.width(), box.height(), kChunkSide);
  first_ = first_cell(box.min);

  const auto x0 = static_cast<float>(grid_T_robot.x - first_.x),
             y0 = static_cast<float>(grid_T_robot.y - first_.y);
  for (const MatchPoint& p : points) {
    const float x = x0 + c * p.x - s * p.y, y = y0 + s * p.x + c * p.y;
    const float around = reach + turn_rad * (std::abs(p.x) + std::abs(p.y)) + 4;
    const int left = static_cast<int>(x - around) >> kChunkBits,
              right = static_cast<int>(x + around) >> kChunkBits;
    const int low = static_cast<int>(y - around) >> kBandBits,
              high = static_cast<int>(y + around) >> kBandBits;
    want({std::max(0, left), std::max(0, low)}, {right, high});
  }
  for (int band = 0; band < height_ / kBand; ++band) {
    for (int cx = 0; cx < chunks_wide_; ++cx) {
      if (!wanted_[static_cast<std::size_t>(band * chunks_wide_ + cx)]) continue;
      const Chunk* from = grid.find({box.min.x + cx, box.min.y + band * kBand / kChunkSide});
      copy_band(from, band, cx, static_cast<unsigned>(gain * 16), unknown);
    }
  }
}

void HitWindow::want(CellIndex low, CellIndex high) {
  const int last_band = std::min(high.y, height_ / kBand - 1),
            last_chunk = std::min(high.x, chunks_wide_ - 1);
  for (int band = low.y; band <= last_band; ++band) {
    for (int cx = low.x; cx <= last_chunk; ++cx)
      wanted_[static_cast<std::size_t>(band * chunks_wide_ + cx)] = 1;
  }
}

void HitWindow::copy_band(const Chunk* from, int band, int chunk, unsigned gain_16, std::uint8_t unknown) {
  std::uint8_t* to = data_.get() + static_cast<std::ptrdiff_t>(band * kBand) * stride_ + chunk * kChunkSide;
  const int first_row = band * kBand & kChunkMask;
  for (int r = first_row; r < first_row + kBand; ++r, to += stride_) {
    if (!from) {
      std::memset(to, unknown, kChunkSide);
      continue;
    }
    if (gain_16 == 16) {
      std::memcpy(to, from->hit[r], kChunkSide);
    } else {
      copy_scaled(from->hit[r], to, gain_16);
    }
    if (unknown > 0) mark_never_seen(*from, r, to, unknown);
  }
}

void HitWindow::pool(const HitWindow& fine) {
  constexpr int kSide = kChunkSide / kPool;
  shape(fine.chunks_wide_, fine.height_ / kChunkSide, kSide);
  first_ = {0, 0};
  for (int y = 0; y < height_; ++y) {
    const int band = y * kPool / kBand;
    for (int k = 0; k < chunks_wide_; ++k) {
      if (!fine.wanted_[static_cast<std::size_t>(band * chunks_wide_ + k)]) continue;
      pool_row(fine.data() + static_cast<std::ptrdiff_t>(y * kPool) * fine.stride() + k * kChunkSide,
               fine.stride(), data_.get() + static_cast<std::ptrdiff_t>(y) * stride_ + k * kSide);
    }
  }
}

}  // namespace dynslam
