// SPDX-License-Identifier: MIT
#pragma once

#include <random>
#include <vector>

#include "grid/chunked_grid.h"
#include "grid/free_space.h"
#include "slam/drawn_world.h"
#include "slam/finished_map.h"
#include "slam/passes.h"

namespace dynslam {

/// How a finished map is made of a drawn world: scans from places on the way, drawn into a frame of their
/// own.
struct MapMaking {
  std::vector<Pose2> world_T_robot;  ///< the first is the map's origin
  Pose2 drawn_T_world = {};          ///< the frame it is drawn in
  double cell_size_m = 0.02;
  double noise_m = 0.01;
  unsigned seed = 1;
  int looks = 4;  ///< from each place
};

inline ChunkedGrid draw_grid(const DrawnWorld& world, const MapMaking& making) {
  ChunkedGrid grid(making.cell_size_m);
  FreeSpace free_space;
  std::mt19937 random(making.seed);
  for (const Pose2& at : making.world_T_robot) {
    for (int i = 0; i < making.looks; ++i) {
      const Scan scan = look(
          world, {}, [&](Time) { return at; }, {.beams = 1000, .turn_s = 0, .noise_m = making.noise_m},
          random);
      const CorrectedScan seen = egomotion_pass(scan, clamp_pass(scan, {}), [](Time) { return Pose2{}; });
      grid.apply(free_space.trace(making.drawn_T_world * at, seen.ends_lidar, 0.02, making.cell_size_m));
    }
  }
  return grid;
}

inline FinishedMap finish(const ChunkedGrid& grid, const Pose2& drawn_T_origin) {
  FinishedMap map;
  map.cell_size_m = grid.cell_size_m();
  map.drawn_T_origin = drawn_T_origin;
  CellBitmap free, occupied;
  free.reset(grid.box());
  occupied.reset(grid.box());
  const Pose2 origin_T_drawn = drawn_T_origin.inverse();
  const CellIndex low = free.first();
  for (int y = low.y; y < low.y + free.rows(); ++y) {
    for (int x = low.x; x < low.x + free.words_per_row() * kChunkSide; ++x) {
      const CellIndex cell{x, y};
      if (grid.state(cell) == CellState::kFree) free.set(cell);
      if (grid.state(cell) != CellState::kOccupied) continue;
      occupied.set(cell);
      const Vector2 p = origin_T_drawn * cell_centre(cell, map.cell_size_m);
      map.cloud.push_back({static_cast<float>(p.x()), static_cast<float>(p.y()), grid.hit(cell)});
    }
  }
  map.free = TiledBitmap(free);
  map.occupied = TiledBitmap(occupied);
  map.outline = thin_out(map.cloud, FinishedMap::kOutline, map.cell_size_m);
  return map;
}

inline FinishedMap finished_map(const DrawnWorld& world, const MapMaking& making) {
  return finish(draw_grid(world, making), making.drawn_T_world * making.world_T_robot.front());
}

}  // namespace dynslam
