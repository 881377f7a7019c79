// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/pose2.h"
#include "grid/chunked_grid.h"

namespace dynslam {

/// A point to match, in the robot's frame, cells.
struct MatchPoint {
  float x = 0.0F;
  float y = 0.0F;
  float weight = 1.0F;  ///< near surfaces get many beams a cell; together they count as one or two
  /// Unit vector across the surface that the point lies on, in the frame of x and y; 0, 0: not known. Beams
  /// far apart leave dots on a surface: what the dots say of the way along it is of the beams, not the place.
  float nx = 0.0F, ny = 0.0F;
};

/// A copy of the hit plane around the points of a scan in one piece of memory, chunk seams gone, so that a
/// row of it can be loaded 16 cells at a time. Only what the points can reach is copied; the rest holds what
/// it holds. Positions are in cells from the window's lower left cell. Keeps its memory from one call to the
/// next.
class HitWindow {
 public:
  /// Cells right of a position that a 16-lane load may read.
  static constexpr int kLanes = 16;

  /// Copies what `points`, at grid_T_robot (x, y in cells), can reach when moved by up to `reach` cells
  /// either way and turned by up to `turn_rad`. Bytes are multiplied by `gain`, up to 255; cells that were
  /// never seen become `unknown` instead of 0.
  void load(const ChunkedGrid& grid, std::span<const MatchPoint> points, const Pose2& grid_T_robot,
            float reach, float turn_rad, float gain = 1, std::uint8_t unknown = 0);
  /// Side of the blocks of cells that pool() puts into one.
  static constexpr int kPool = 4;
  /// The maximum of each block of kPool by kPool cells of `fine`, where `fine` holds something.
  void pool(const HitWindow& fine);

  /// The cell of the grid that is the window's cell (0, 0).
  CellIndex first() const { return first_; }
  int stride() const { return stride_; }
  int height() const { return height_; }
  const std::uint8_t* data() const { return data_.get(); }
  bool contains(int x, int y) const { return x >= 0 && y >= 0 && x + kLanes <= stride_ && y < height_; }

 private:
  void shape(int chunks_wide, int chunks_high, int side);
  void want(CellIndex low, CellIndex high);
  void copy_band(const Chunk* from, int band, int chunk, unsigned gain_16, std::uint8_t unknown);

  CellIndex first_;
  int stride_ = 0;
  int height_ = 0;
  int chunks_wide_ = 0;
  std::vector<std::uint8_t> wanted_;  ///< a flag for each band of rows of each chunk
  std::unique_ptr<std::uint8_t[]> data_;
  std::size_t capacity_ = 0;
};

}  // namespace dynslam
