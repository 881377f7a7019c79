// SPDX-License-Identifier: MIT
#include "plan/chunk_clearance.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "grid/spread_bits.h"

namespace dynslam {
namespace {

/// So that the squares of two distances fit into 16 bits together.
constexpr int kMostReach = 180;
constexpr int kBlock = 16;
constexpr int kStepsBetweenLooks = 4;

int reach_in_cells(double cell_size_m, double reach_m) {
  return static_cast<int>(std::clamp(std::ceil(reach_m / cell_size_m - 1e-9), 1.0, double{kMostReach}));
}

}  // namespace

ChunkClearance::ChunkClearance(double cell_size_m, double reach_m)
    : reach_(reach_in_cells(cell_size_m, reach_m)),
      side_chunks_((reach_ + kChunkSide - 1) / kChunkSide),
      width_((2 * side_chunks_ + 1) * kChunkSide) {
  const double cut_m = reach_ == kMostReach ? kMostReach * cell_size_m : reach_m;
  for (int square = 0; square <= reach_ * reach_ + 1; ++square) {
    const double distance_m =
        square > reach_ * reach_ ? cut_m : std::min(cut_m, std::sqrt(square) * cell_size_m);
    steps_.push_back(static_cast<std::uint8_t>(std::floor(distance_m / kClearanceStep_m + 1e-6)));
  }
  for (int d = 0; d <= reach_; ++d) squares_.push_back(static_cast<std::uint16_t>(d * d));
  squares_.push_back(static_cast<std::uint16_t>(65535 - reach_ * reach_));
  const auto width = static_cast<std::size_t>(width_);
  blocked_.resize(static_cast<std::size_t>(kChunkSide + 2 * reach_) * (width / kChunkSide));
  distance_.resize(width);
  columns_.resize(kChunkSide * width);
  row_square_.resize(width);
}

bool ChunkClearance::compute(const CellBitmap& occupied, const CellBitmap& forbidden, ChunkIndex chunk,
                             ClearanceTile& out) {
  if (!gather(occupied, forbidden, chunk)) return false;
  measure_columns();
  for (int r = 0; r < kChunkSide; ++r) measure_row(r, out[static_cast<std::size_t>(r)]);
  return true;
}

/// Whether anything is blocked in the window.
bool ChunkClearance::gather(const CellBitmap& occupied, const CellBitmap& forbidden, ChunkIndex chunk) {
  const ChunkBox& box = occupied.box();
  const int first_row = (chunk.y - box.min.y) * kChunkSide - reach_;
  const int first_word = chunk.x - box.min.x - side_chunks_;
  std::uint64_t any = 0;
  std::uint64_t* to = blocked_.data();
  for (int r = 0; r < kChunkSide + 2 * reach_; ++r) {
    const int row = first_row + r;
    const bool has_row = row >= 0 && row < occupied.rows();
    for (int w = first_word; w <= first_word + 2 * side_chunks_; ++w) {
      const bool inside = has_row && w >= 0 && w < occupied.words_per_row();
      *to = inside ? occupied.row(row)[w] | forbidden.row(row)[w] : 0;
      any |= *to++;
    }
  }
  return any != 0;
}

/// From the distances of a row to those of the next.
void ChunkClearance::step_column_distances(int window_row) {
  const int words = width_ / kChunkSide;
  const std::uint64_t* bits = &blocked_[static_cast<std::size_t>(window_row * words)];
  const auto far = static_cast<std::uint8_t>(reach_ + 1);
  for (int w = 0; w < words; ++w) {
    alignas(64) std::uint8_t is_blocked[kChunkSide];
    for (int i = 0; i < 8; ++i) std::memcpy(is_blocked + 8 * i, &kSpreadBits[(bits[w] >> (8 * i)) & 0xFF], 8);
    std::uint8_t* d = &distance_[static_cast<std::size_t>(w * kChunkSide)];
    for (int i = 0; i < kChunkSide; ++i) {
      const std::uint8_t next = std::min(static_cast<std::uint8_t>(d[i] + 1), far);
      d[i] = static_cast<std::uint8_t>(next & ~is_blocked[i]);
    }
  }
}

void ChunkClearance::measure_columns() {
  const auto far = static_cast<std::uint8_t>(reach_ + 1);
  const auto row_at = [this](int window_row) { return columns_.begin() + (window_row - reach_) * width_; };
  std::fill(distance_.begin(), distance_.end(), far);
  for (int r = 0; r < reach_ + kChunkSide; ++r) {
    step_column_distances(r);
    if (r >= reach_) std::copy(distance_.begin(), distance_.end(), row_at(r));
  }
  std::fill(distance_.begin(), distance_.end(), far);
  for (int r = 2 * reach_ + kChunkSide - 1; r >= reach_; --r) {
    step_column_distances(r);
    if (r >= reach_ + kChunkSide) continue;
    const auto row = row_at(r);
    for (int i = 0; i < width_; ++i) row[i] = std::min(row[i], distance_[static_cast<std::size_t>(i)]);
  }
}

void ChunkClearance::measure_row(int row, std::array<std::uint8_t, kChunkSide>& out) {
  const std::uint8_t* columns = &columns_[static_cast<std::size_t>(row * width_)];
  for (int i = 0; i < width_; ++i) row_square_[static_cast<std::size_t>(i)] = squares_[columns[i]];
  for (int first = 0; first < kChunkSide; first += kBlock) {
    const std::uint16_t* here = &row_square_[static_cast<std::size_t>(side_chunks_ * kChunkSide + first)];
    std::uint16_t least[kBlock];
    std::copy(here, here + kBlock, least);
    for (int dx = 1; dx <= reach_; ++dx) {
      if (dx % kStepsBetweenLooks == 1 && dx * dx >= *std::max_element(least, least + kBlock)) break;
      const auto square = static_cast<std::uint16_t>(dx * dx);
      for (int i = 0; i < kBlock; ++i) {
        const auto nearer = static_cast<std::uint16_t>(std::min(here[i - dx], here[i + dx]) + square);
        least[i] = std::min(least[i], nearer);
      }
    }
    for (int i = 0; i < kBlock; ++i) {
      const auto square = std::min<std::size_t>(least[i], steps_.size() - 1);
      out[static_cast<std::size_t>(first + i)] = steps_[square];
    }
  }
}

}  // namespace dynslam
