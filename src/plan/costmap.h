// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/pose2.h"
#include "grid/chunked_grid.h"
#include "plan/cell_states.h"
#include "plan/chunk_clearance.h"
#include "plan/coarse_grid.h"

namespace dynslam {

/// What planning needs to know of a map, kept up to date from one snapshot to the next: how much room there
/// is around each cell. No-go areas count as occupied. Work goes with what became occupied or free, not with
/// the size of the map: of the other chunks only the versions are compared.
///
/// Memory: 3 bits a cell and 3 bytes for 4 x 4 cells inside the map's box; a byte a cell in the chunks that
/// have something occupied within reach. Of a map whose box would be more than kMostChunks large, what lies
/// outside of the box that there was before is left out.
/// Threads: one at a time.
class Costmap {
 public:
  static constexpr double kReach_m = 1.0;
  /// A post may be the middle of something that is so wide below the lidar, the robot's width added.
  static constexpr double kPostBerth_m = 0.5;
  static constexpr std::size_t kMostChunks = 16384;
  /// Corners of no-go areas that are looked at, all together; areas beyond are left out.
  static constexpr std::size_t kMostCorners = 4096;

  explicit Costmap(double cell_size_m);

  /// Takes in what changed; returns the number of chunks whose clearance was computed anew. REQUIRES: cells
  /// of the same size, and always snapshots of the same grid.
  std::size_t update(const GridSnapshot& map);
  /// Simple polygons in map metres; cells inside count as occupied from the next update on. Outlines that are
  /// none are ignored, what lies outside of the map's box has no effect.
  void set_forbidden(std::span<const std::vector<Vector2>> outlines_map);

  /// From the centre of the point's cell to that of the nearest occupied one, in steps of 4 mm, rounded down;
  /// 0 in an occupied cell, at most kReach_m (180 cells when those are less), kReach_m where nothing is
  /// known, 0 of a point that is not finite.
  double clearance_m(const Vector2& point_map) const;
  /// Forbidden shows as occupied.
  CellState state(const Vector2& point_map) const;

  double cell_size_m() const { return cell_size_m_; }
  const ChunkBox& box() const { return occupied_.box(); }
  bool contains(const Vector2& point_map) const;
  /// False outside of the box, as are the next three.
  bool contains(CellIndex c) const { return occupied_.contains(c); }
  bool is_forbidden(CellIndex c) const { return forbidden_.test(c); }
  bool is_known(CellIndex c) const { return known_.test(c); }
  /// In the map itself, whatever is forbidden.
  bool is_occupied(CellIndex c) const { return occupied_.test(c); }

  /// REQUIRES: contains(c).
  std::uint8_t clearance_steps(CellIndex c) const {
    const ClearanceTile* tile = tiles_[place_of(chunk_of(c))].get();
    return tile ? (*tile)[static_cast<std::size_t>(c.y & kChunkMask)]
                         [static_cast<std::size_t>(c.x & kChunkMask)]
                : chunk_clearance_.most();
  }
  const CoarseGrid& coarse() const { return coarse_; }

 private:
  /// The copy of a chunk that was taken in.
  struct Seen {
    const Chunk* chunk = nullptr;
    std::uint64_t version = 0;
  };
  enum Stale : std::uint8_t { kCoarse = 1, kClearance = 2 };

  std::size_t place_of(ChunkIndex c) const {
    return static_cast<std::size_t>(c.y - box().min.y) * static_cast<std::size_t>(box().width()) +
           static_cast<std::size_t>(c.x - box().min.x);
  }
  void cover(const ChunkBox& wanted);
  void take_in(ChunkIndex index, const Chunk* chunk);
  void draw_forbidden();
  void mark_near(ChunkIndex index, const CellTile& before, const CellTile& after);
  void refresh_clearance(ChunkIndex index);
  void refresh_coarse(ChunkIndex index);
  void mark_posts(ChunkIndex index);

  double cell_size_m_;
  ChunkClearance chunk_clearance_;
  CellBitmap occupied_, known_, forbidden_;
  std::vector<std::unique_ptr<ClearanceTile>> tiles_;  ///< null: nothing within reach
  std::vector<Seen> seen_;
  std::vector<std::uint8_t> stale_;
  CoarseGrid coarse_;
  std::vector<std::vector<Vector2>> outlines_;
  bool forbidden_is_stale_ = false;
};

}  // namespace dynslam
