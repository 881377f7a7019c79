// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "base/pose2.h"
#include "grid/chunked_grid.h"

namespace dynslam {

/// Where a ray from a frame's origin came to its end, in that frame.
struct RayEnd {
  float x_m = 0.0F;
  float y_m = 0.0F;
  float bearing_rad = 0.0F;  ///< atan2(y, x)
  float range_m = 0.0F;
  bool hit = false;  ///< something is there; otherwise the ray was cut short and only its way is known
};

/// Turns the rays of a scan into the cells they passed and the cells they hit.
///
/// The free space of a scan is a star-shaped polygon: its corners are the ray ends, and between two rays next
/// to each other the wedge is free too (thesis 4.1.2), up to the nearer end where the surface breaks off. A
/// cell is passed when its centre lies in the polygon, or when a ray that stands alone crosses it. The
/// polygon is filled by parity: each edge toggles one bit a row, then a running exclusive or along the row
/// fills it; rays far apart and close together cost the same, and no cell is touched twice. Keeps its buffers
/// between calls. One thread.
class FreeSpace {
 public:
  /// `ends` in order of bearing; rays farther apart than `max_wedge_rad` have nothing between them.
  /// The result holds until the next call. The extent of the rays is what the result's memory is made for:
  /// the caller bounds their length.
  const ScanFootprint& trace(const Pose2& grid_T_origin, std::span<const RayEnd> ends, double max_wedge_rad,
                             double cell_size_m);

 private:
  struct Corner {
    float x, y;  ///< cells, from the bitmap's first
  };
  void place(const Pose2& grid_T_origin, std::span<const RayEnd> ends, double cell_size_m);
  void add_edge(Corner a, Corner b);
  void add_wedge(const RayEnd& a, const RayEnd& b, Corner corner_a, Corner corner_b);
  void outline(std::span<const RayEnd> ends, double max_wedge_rad);
  void fill();
  void walk_lone_ray(Corner end);
  void mark_hit(CellIndex c);
  void mark_hits(std::span<const RayEnd> ends, double max_wedge_rad, double cell_size_m);

  ScanFootprint footprint_;
  CellBitmap hit_bits_;
  std::vector<Corner> corners_;  ///< of each ray end
  std::vector<Corner> lone_;     ///< ends of rays without neighbours on the same surface
  Corner centre_{};
};

}  // namespace dynslam
