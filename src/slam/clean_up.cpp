// SPDX-License-Identifier: MIT
#include "slam/clean_up.h"

#include <cstdlib>
#include <vector>

#include "grid/flood_fill.h"
#include "slam/map_sight.h"

namespace dynslam {
namespace {

/// How far, in cells, hits that are not the crest themselves may lie in front of it.
constexpr int kWallHalf = 2;

std::uint64_t word_or_none(const CellBitmap& bits, int row, int word) {
  return row < 0 || row >= bits.rows() || word < 0 || word >= bits.words_per_row() ? 0 : bits.row(row)[word];
}

/// The cells of a word's row that are in the set or beside one that is.
std::uint64_t with_sides(const CellBitmap& bits, int row, int word) {
  const std::uint64_t here = word_or_none(bits, row, word);
  return here | (here << 1) | (here >> 1) | (word_or_none(bits, row, word - 1) >> 63) |
         (word_or_none(bits, row, word + 1) << 63);
}

/// The set and its four neighbours of each cell, or with the corners all eight.
CellBitmap grown(const CellBitmap& bits, bool corners) {
  CellBitmap out;
  out.reset(bits.box());
  for (int r = 0; r < bits.rows(); ++r) {
    for (int w = 0; w < bits.words_per_row(); ++w) {
      const std::uint64_t below = corners ? with_sides(bits, r - 1, w) : word_or_none(bits, r - 1, w);
      const std::uint64_t above = corners ? with_sides(bits, r + 1, w) : word_or_none(bits, r + 1, w);
      out.row(r)[w] = with_sides(bits, r, w) | below | above;
    }
  }
  return out;
}

void keep_only(CellBitmap& bits, const CellBitmap& mask) {
  for (int r = 0; r < bits.rows(); ++r) {
    for (int w = 0; w < bits.words_per_row(); ++w) bits.row(r)[w] &= mask.row(r)[w];
  }
}

void take_out(CellBitmap& bits, const CellBitmap& others) {
  for (int r = 0; r < bits.rows(); ++r) {
    for (int w = 0; w < bits.words_per_row(); ++w) bits.row(r)[w] &= ~others.row(r)[w];
  }
}

void add_all(CellBitmap& bits, const CellBitmap& more) {
  for (int r = 0; r < bits.rows(); ++r) {
    for (int w = 0; w < bits.words_per_row(); ++w) bits.row(r)[w] |= more.row(r)[w];
  }
}

/// The slopes of walls on the side they were seen from: a crest is not behind more than kWallHalf of them.
CellBitmap front_slopes(const CellBitmap& reached, const CellBitmap& thick) {
  CellBitmap front = reached;
  for (int step = 0; step < kWallHalf; ++step) {
    CellBitmap next = grown(front, false);
    keep_only(next, thick);
    add_all(front, next);
  }
  return front;
}

/// The cells not seen at all and those within kRimWidth of one. Rays that graze a wall end far apart along it, and what
/// lies between counts as passed, wall and all: the edge of what was seen proves nothing.
CellBitmap rim_of_unseen(const Sight& sight) {
  CellBitmap rim;
  rim.reset(sight.crest.box());
  for (int r = 0; r < rim.rows(); ++r) {
    for (int w = 0; w < rim.words_per_row(); ++w) {
      rim.row(r)[w] = ~(sight.crest.row(r)[w] | sight.seen_through.row(r)[w] | sight.thick.row(r)[w]);
    }
  }
  static const int n = std::getenv("RIM") ? std::atoi(std::getenv("RIM")) : 2;
  for (int step = 0; step < n; ++step) rim = grown(rim, true);
  return rim;
}

std::vector<CellIndex> cells_of(std::span<const Vector2> points, double cell_size_m) {
  std::vector<CellIndex> cells;
  for (const Vector2& p : points) cells.push_back(cell_at(p, cell_size_m));
  return cells;
}

/// The crests that were kept as points in the frame of the local map's origin.
std::vector<CloudPoint> cloud_of(const std::vector<Crest>& crests, const CellBitmap& kept, const LocalMap& map) {
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
  const CellBitmap reached = flood_fill(sight.seen_through, cells_of(map.robot_positions, out.cell_size_m));
  CellBitmap front = front_slopes(reached, sight.thick);
  out.occupied = sight.crest;
  keep_only(out.occupied, grown(front, true));
  out.free = reached;
  take_out(out.free, sight.doubtful);
  take_out(out.free, rim_of_unseen(sight));
  // What hid the crest from view was not there: the ray had to pass it.
  keep_only(front, grown(grown(out.occupied, true), true));
  add_all(out.free, front);
  take_out(out.free, out.occupied);
  out.cloud = cloud_of(sight.crests, out.occupied, map);
  return out;
}

void drop_unseen(CellBitmap& free, CellBitmap& occupied, std::span<const CellIndex> seeds) {
  free = flood_fill(free, seeds);
  keep_only(occupied, grown(free, true));
}

}  // namespace dynslam
