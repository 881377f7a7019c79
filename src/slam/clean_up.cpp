// SPDX-License-Identifier: MIT
#include "slam/clean_up.h"

#include <vector>

#include "grid/bitmap_sets.h"
#include "grid/flood_fill.h"
#include "slam/map_sight.h"

namespace dynslam {
namespace {

/// How far, in cells, hits that are not the crest themselves may lie in front of it.
constexpr int kSlopeWidth = 2;

/// The edge of what was seen proves nothing, so many cells wide: rays that graze a wall end far apart along
/// it, and what lies between two ends counts as passed, be it the wall itself.
constexpr int kRimWidth = 2;

/// What was reached, and the slopes of walls on the side they were seen from: a crest is not behind more than
/// kSlopeWidth cells that hold hits, or that were left out for being next to one.
CellBitmap with_slopes(const CellBitmap& reached, const CellBitmap& crest) {
  CellBitmap front = reached;
  for (int step = 0; step < kSlopeWidth; ++step) {
    front = grown_by_sides(front);
    take_out(front, crest);
  }
  return front;
}

/// Grows a set by steps to the sides that lead into no wall: diagonal walls hold them too.
void grow_up_to(CellBitmap& cells, const CellBitmap& walls, int times) {
  for (int i = 0; i < times; ++i) {
    cells = grown_by_sides(cells);
    take_out(cells, walls);
  }
}

/// Surfaces as what no way leads through: rays that graze a wall pass between its hits, and around the last
/// of them.
CellBitmap without_gaps(const Sight& sight) {
  CellBitmap closed = sight.faint;
  add_all(closed, gaps_in_lines(sight.crest));
  return closed;
}

/// The cells not seen at all and those near one.
CellBitmap rim_of_unseen(const Sight& sight) {
  CellBitmap unseen;
  unseen.reset(sight.crest.box());
  for (int r = 0; r < unseen.rows(); ++r) {
    for (int w = 0; w < unseen.words_per_row(); ++w) {
      unseen.row(r)[w] = ~(sight.crest.row(r)[w] | sight.seen_through.row(r)[w] | sight.thick.row(r)[w]);
    }
  }
  return grown_all_round(unseen, kRimWidth);
}

std::vector<CellIndex> cells_of(std::span<const Vector2> points, double cell_size_m) {
  std::vector<CellIndex> cells;
  for (const Vector2& p : points) cells.push_back(cell_at(p, cell_size_m));
  return cells;
}

/// The crests that were kept as points in the frame of the local map's origin.
std::vector<CloudPoint> cloud_of(const std::vector<Crest>& crests, const CellBitmap& kept,
                                 const LocalMap& map) {
  const Pose2 origin_T_drawn = map.map_T_origin.inverse();
  std::vector<CloudPoint> cloud;
  for (const Crest& c : crests) {
    if (!kept.test(c.cell)) continue;
    const double cell_m = map.grid.cell_size_m();
    const Vector2 at = origin_T_drawn * Vector2(cell_centre(c.cell, cell_m) + cell_m * Vector2(c.dx, c.dy));
    cloud.push_back({static_cast<float>(at.x()), static_cast<float>(at.y()), c.hit});
  }
  return cloud;
}

}  // namespace

FinishedMap clean_up(const LocalMap& map, std::uint32_t id, Time ended) {
  FinishedMap out;
  out.id = id;
  out.cell_size_m = map.grid.cell_size_m();
  out.drawn_T_origin = map.map_T_origin;
  out.begun = map.begun;
  out.ended = ended;
  const Sight sight = sight_of(map.grid);
  const CellBitmap closed = without_gaps(sight);
  CellBitmap through = sight.seen_through;
  take_out(through, closed);
  const CellBitmap reached = flood_fill(through, cells_of(map.robot_positions, out.cell_size_m));
  CellBitmap front = with_slopes(reached, closed);
  CellBitmap occupied = sight.crest;
  keep_only(occupied, grown_all_round(front));
  CellBitmap free = reached;
  take_out(free, sight.doubtful);
  take_out(free, rim_of_unseen(sight));
  // What hid the crest from view was not there: the ray had to pass it. Past the end of one, who knows.
  keep_only(front, grown_across(occupied));
  add_all(free, front);
  take_out(free, occupied);
  out.free = TiledBitmap(free);
  out.occupied = TiledBitmap(occupied);
  out.cloud = cloud_of(sight.crests, occupied, map);
  out.outline = thin_out(out.cloud, FinishedMap::kOutline, out.cell_size_m);
  return out;
}

void mend_walls(CellBitmap& occupied, const CellBitmap& free) {
  CellBitmap gaps = gaps_in_lines(occupied);
  take_out(gaps, free);
  add_all(occupied, gaps);
}

void fill_cracks(CellBitmap& free, const CellBitmap& occupied, int crack_cells) {
  CellBitmap filled = free;
  grow_up_to(filled, occupied, crack_cells / 2);
  CellBitmap unknown = complement(filled);
  take_out(unknown, occupied);
  grow_up_to(unknown, occupied, crack_cells / 2);
  take_out(filled, unknown);
  add_all(free, filled);
}

void drop_gaps(CellBitmap& free, CellBitmap& occupied, int gap_cells) {
  free = flood_fill(free, shrunk_all_round(free, gap_cells / 2));
  CellBitmap before = grown_by_sides(free);
  take_out(before, occupied);
  CellBitmap in_view = occupied;
  keep_only(in_view, grown_all_round(before));
  take_out(occupied, grown_all_round(in_view, gap_cells / 2));
  add_all(occupied, in_view);
}

}  // namespace dynslam
