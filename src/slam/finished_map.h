// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "base/pose2.h"
#include "base/time.h"
#include "grid/tiled_bitmap.h"

namespace dynslam {

/// A point on a surface that a local map saw.
struct CloudPoint {
  float x_m = 0.0F;  ///< in the frame of the local map's origin
  float y_m = 0.0F;
  std::uint8_t weight = 0;  ///< how often it was hit: the hit byte of its cell
};

/// What is kept of a local map when it is complete and cleaned: an eighth of a byte a cell instead of two
/// bytes. The bitmaps' cells are those of the frame in which the local map was drawn (the front end's
/// continuous frame); everything else about it lives in the frame of its origin. Immutable once made; any
/// thread may read it.
struct FinishedMap {
  std::uint32_t id = 0;  ///< counted up; a larger id is a newer map
  static constexpr std::size_t kOutline = 800;
  double cell_size_m = 0.02;
  Pose2 drawn_T_origin;           ///< the robot's pose when the map was begun, in the frame it was drawn in
  Time begun, ended;              ///< stamps of its first and last scan
  TiledBitmap free;               ///< seen to be empty
  TiledBitmap occupied;           ///< surfaces, about one cell thick; never also free
  std::vector<CloudPoint> cloud;  ///< the occupied cells as points
  std::vector<Vector2> outline;   ///< at most kOutline points, evenly over the same surfaces
};

/// At most `most` points of a cloud, evenly over its surfaces: one for each square of a lattice that is as
/// fine as that allows, the mean of the points in it. (The first of them would be the lowest of a wall some
/// cells thick, and the whole cloud half a wall off.)
std::vector<Vector2> thin_out(const std::vector<Vector2>& points, std::size_t most, double least_step_m);
std::vector<Vector2> thin_out(const std::vector<CloudPoint>& cloud, std::size_t most, double least_step_m);

}  // namespace dynslam
