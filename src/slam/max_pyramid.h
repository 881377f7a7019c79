// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "grid/cell_bitmap.h"
#include "slam/finished_map.h"

namespace dynslam {

struct MaxPyramidConfig {
  /// Side of a cell of the lowest level, at least: that is 2, 4 or 8 cells of the map.
  double least_cell_m = 0.04;
  double clear_m = 0.1;  ///< a point in free space this far from every surface contradicts the map
  /// What a point in space that was never seen scores, of 255 for one on a surface; in free space it scores
  /// nothing. Otherwise a search would rather push two maps over each other than let one reach beyond the
  /// other.
  std::uint8_t unknown_worth = 80;
};

/// The surfaces of a finished map as bytes (255: on one; a cell away: a third), and above them levels that
/// hold the maxima of more and more of them: upper bounds for whole blocks of shifts (branch and bound, Hess
/// et al., ICRA 2016).
///
/// Cells lie in the frame the map was drawn in, a few of its cells each, and are counted from the lower left
/// one. Cell (i, j) of level k holds the maximum of the base cells [i S, i S + 2 S - 2] in x and likewise in
/// y, S = 2^k: whatever base cell a point lies in, the one cell (x >> k, y >> k) bounds what it scores under
/// all shifts by 0 to S - 1, and the cells right of it bound the blocks of shifts right of that. The paper
/// keeps every level at full resolution, which is tighter by half a block and takes a plane a level; this
/// takes a third more than the base alone. A map of 12 x 9 m takes some 130 KB. Immutable; any thread may
/// read it.
class MaxPyramid {
 public:
  static constexpr int kLanes = 16;  ///< cells right of a position that a load may read
  static constexpr int kLevels = 5;

  /// One level, with a rim of unknown cells wide enough for loads that lie beside it.
  struct Plane {
    static constexpr int kLeft = kLanes + 1;  ///< a cell that reaches into the map from outside, and a load
    static constexpr int kBelow = 2;
    int width = 0, height = 0;  ///< without the rim
    std::vector<std::uint8_t> bytes;

    int stride() const { return kLeft + width + kLanes; }
    std::int32_t offset(std::int32_t x, std::int32_t y) const {
      return (std::clamp(y, -kBelow, height) + kBelow) * stride() + std::clamp(x, -kLeft, width) + kLeft;
    }
  };

  explicit MaxPyramid(const FinishedMap& map, const MaxPyramidConfig& config = {});

  double cell_size_m() const { return cell_size_m_; }
  std::uint8_t unknown_worth() const { return unknown_worth_; }
  int width() const { return planes_[0].width; }  ///< base cells
  int height() const { return planes_[0].height; }

  const Plane& plane(int level) const { return planes_[static_cast<std::size_t>(level)]; }
  const std::uint8_t* data(int level) const { return plane(level).bytes.data(); }
  /// Where in data(level) the cell is; any cell will do, and 16 bytes from there can be read. Beyond the map
  /// everything is unknown.
  std::int32_t offset(int level, std::int32_t x, std::int32_t y) const { return plane(level).offset(x, y); }
  std::uint8_t value(int level, CellIndex c) const { return data(level)[offset(level, c.x, c.y)]; }

  /// Seen: free or next to a surface.
  bool is_known(CellIndex base) const { return known_.test(base); }
  /// Seen to be free, and well away from every surface.
  bool is_clear(CellIndex base) const { return clear_.test(base); }
  /// The base cell of a point of the frame the map was drawn in; it must be within 2^30 cells.
  CellIndex cell_of(const Vector2& drawn_m) const {
    const CellIndex c = cell_at(drawn_m, cell_size_m_);
    return {c.x - first_.x, c.y - first_.y};
  }
  std::size_t bytes() const;

 private:
  void measure(const FinishedMap& map);
  void draw_free(const FinishedMap& map);
  std::optional<Vector2> base_position(const FinishedMap& map, const CloudPoint& p) const;
  void draw_surfaces(const FinishedMap& map);
  void clear_around_surfaces(const FinishedMap& map, double clear_m);
  void stack();

  int map_cell_bits_;  ///< a base cell is 2 to the power of this map cells wide
  double cell_size_m_;
  std::uint8_t unknown_worth_;
  CellIndex first_;  ///< counted in base cells from the frame's origin
  std::vector<Plane> planes_;
  CellBitmap known_, clear_;
};

}  // namespace dynslam
