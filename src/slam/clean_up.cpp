// SPDX-License-Identifier: MIT
#include "slam/clean_up.h"

#include <vector>

#include "grid/flood_fill.h"
#include "slam/ridges.h"

namespace dynslam {
namespace {

/// How far, in cells, hits that are not the crest themselves may lie in front of it.
constexpr int kWallHalf = 2;

/// What the bytes say of the cells that are no crest.
struct Sight {
  CellBitmap seen_through;  ///< at least as many misses as hits
  CellBitmap thick;         ///< more hits than misses: the slopes of walls, noise
};

/// One bit a flag; the flags are 0 or 1.
std::uint64_t packed(const std::uint8_t (&flags)[kChunkSide]) {
  std::uint64_t bits = 0;
  for (int i = 0; i < kChunkSide; i += 8) {
    std::uint64_t eight = 0;
    for (int k = 0; k < 8; ++k) eight |= std::uint64_t{flags[i + k]} << (8 * k);
    // Gathers the lowest bits of eight bytes in the highest byte.
    bits |= ((eight * 0x0102040810204080ULL) >> 56) << i;
  }
  return bits;
}

Sight sight_of(const ChunkedGrid& grid, const CellBitmap& ridges) {
  const ChunkBox& box = grid.box();
  Sight sight;
  sight.seen_through.reset(box);
  sight.thick.reset(box);
  std::uint8_t seen[kChunkSide], thick[kChunkSide];
  for (int r = 0; r < ridges.rows(); ++r) {
    for (int w = 0; w < ridges.words_per_row(); ++w) {
      const Chunk* chunk = grid.find({box.min.x + w, box.min.y + r / kChunkSide});
      if (!chunk) continue;
      const std::uint8_t* hit = chunk->hit[r & kChunkMask];
      const std::uint8_t* miss = chunk->miss[r & kChunkMask];
      for (int i = 0; i < kChunkSide; ++i) {
        seen[i] = (miss[i] > 0) & (miss[i] >= hit[i]);
        thick[i] = hit[i] > miss[i];
      }
      const std::uint64_t ridge = ridges.row(r)[w];
      sight.seen_through.row(r)[w] = packed(seen) & ~ridge;
      sight.thick.row(r)[w] = packed(thick) & ~ridge;
    }
  }
  return sight;
}

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

std::vector<CellIndex> cells_of(std::span<const Vector2> points, double cell_size_m) {
  std::vector<CellIndex> cells;
  for (const Vector2& p : points) cells.push_back(cell_at(p, cell_size_m));
  return cells;
}

CellBitmap bitmap_of(const std::vector<Crest>& crests, const ChunkBox& box) {
  CellBitmap cells;
  cells.reset(box);
  for (const Crest& c : crests) cells.set(c.cell);
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
  const std::vector<Crest> crests = find_crests(map.grid);
  out.occupied = bitmap_of(crests, map.grid.box());
  const Sight sight = sight_of(map.grid, out.occupied);
  const auto seeds = cells_of(map.robot_positions, out.cell_size_m);
  out.free = flood_fill(sight.seen_through, seeds);
  CellBitmap front = front_slopes(out.free, sight.thick);
  keep_only(out.occupied, grown(front, true));
  // What hid the crest from view was not there: the ray had to pass it.
  keep_only(front, grown(grown(out.occupied, true), true));
  add_all(out.free, front);
  out.cloud = cloud_of(crests, out.occupied, map);
  return out;
}

void drop_unseen(CellBitmap& free, CellBitmap& occupied, std::span<const CellIndex> seeds) {
  free = flood_fill(free, seeds);
  keep_only(occupied, grown(free, true));
}

}  // namespace dynslam
