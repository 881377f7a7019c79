// SPDX-License-Identifier: MIT
#include "slam/map_sight.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>

#include "base/angles.h"
#include "grid/bitmap_sets.h"

namespace dynslam {
namespace {

constexpr int kReach = 2;  ///< cells, of the smoothing and of the comparison each
constexpr int kRim = 2 * kReach;
constexpr int kSide = kChunkSide + 2 * kRim;
/// Found on simulated recordings: less lets in noise, more loses walls seen from far off or at a grazing
/// angle.
constexpr int kLeastHits = 15 * 256;
/// Enough between surfaces that are clear, no farther from them than so many cells: at corners, and where
/// beams graze a wall.
constexpr int kLeastFaintHits = 5 * 256;
constexpr int kFaintReach = 3;
/// What more than five rays passed for each hit, smoothed, is a gap between two posts.
constexpr int kFaintHitsPerMiss = 256 / 5;
/// A lidar with few beams passes a wall's cell between two hits more often than it hits it.
constexpr int kMissesPerHit = 3;
/// One hit within two cells is enough for doubt.
constexpr int kDoubtfulHits = 64;

/// The hits of a chunk and of a rim around it, and the same smoothed by the binomial 1 4 6 4 1 both ways. A
/// wall drawn twice, up to two cells apart, has one crest in it.
class SmoothChunk {
 public:
  /// False when there are no hits.
  bool load(const ChunkedGrid& grid, ChunkIndex index);
  /// Smoothed hits, 0 to 256 * 255 (256 is the sum of the weights); for cells no more than kReach outside of
  /// the chunk.
  const std::uint16_t& at(int x, int y) const { return smooth_[y + kRim][x + kRim]; }

 private:
  void smooth();

  std::uint8_t hit_[kSide][kSide];
  std::uint16_t along_[kSide][kSide];
  std::uint16_t smooth_[kSide][kSide];
};

bool SmoothChunk::load(const ChunkedGrid& grid, ChunkIndex index) {
  std::memset(hit_, 0, sizeof hit_);
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      const Chunk* chunk = grid.find({index.x + dx, index.y + dy});
      if (!chunk) continue;
      const int x0 = dx < 0 ? kChunkSide - kRim : 0, x1 = dx > 0 ? kRim : kChunkSide;
      const int y0 = dy < 0 ? kChunkSide - kRim : 0, y1 = dy > 0 ? kRim : kChunkSide;
      for (int y = y0; y < y1; ++y) {
        std::memcpy(&hit_[y + dy * kChunkSide + kRim][x0 + dx * kChunkSide + kRim], &chunk->hit[y][x0],
                    static_cast<std::size_t>(x1 - x0));
      }
    }
  }
  const std::uint8_t* const all = &hit_[0][0];
  std::uint8_t any = 0;
  for (int i = 0; i < kSide * kSide; ++i) any |= all[i];
  if (any != 0) smooth();
  return any != 0;
}

void SmoothChunk::smooth() {
  for (int y = 0; y < kSide; ++y) {
    const std::uint8_t* h = hit_[y];
    for (int x = kReach; x < kSide - kReach; ++x) {
      along_[y][x] = static_cast<std::uint16_t>(h[x - 2] + h[x + 2] + 4 * (h[x - 1] + h[x + 1]) + 6 * h[x]);
    }
  }
  for (int y = kReach; y < kSide - kReach; ++y) {
    for (int x = kReach; x < kSide - kReach; ++x) {
      smooth_[y][x] = static_cast<std::uint16_t>(
          along_[y - 2][x] + along_[y + 2][x] + 4 * (along_[y - 1][x] + along_[y + 1][x]) + 6 * along_[y][x]);
    }
  }
}

/// A crest among five cells in a row, `step` apart. Of equals the last is it.
bool is_crest(const std::uint16_t* s, std::ptrdiff_t step) {
  return s[0] >= s[-step] && s[0] >= s[-2 * step] && s[0] > s[step] && s[0] > s[2 * step];
}

/// Where between the cells beside a crest its top is: -0.5 to 0.5 of a cell from the middle, by a parabola.
float offset_of_top(const std::uint16_t* s, std::ptrdiff_t step) {
  const int before = s[-step], after = s[step], bend = 2 * s[0] - before - after;
  return bend <= 0
             ? 0.0F
             : std::clamp(0.5F * static_cast<float>(after - before) / static_cast<float>(bend), -0.5F, 0.5F);
}

/// Whether the hits of a cell stand for a surface.
bool is_surface(std::uint16_t smoothed, std::uint8_t hit, std::uint8_t miss) {
  return smoothed >= kLeastHits && kMissesPerHit * hit >= miss;
}

/// From the middle of a cell to the top of the crest over it, in cells; nothing where it is not under one.
/// The wall is crossed along the axis that leads farther down: on a slope that is the way to its foot, so
/// that bumps along the slope are no crests.
std::optional<Eigen::Vector2f> crest_at(const std::uint16_t* s) {
  const std::uint16_t *left = s - kReach, *right = s + kReach, *low = s - kReach * kSide,
                      *high = s + kReach * kSide;
  const int foot_x = std::min(*left, *right), foot_y = std::min(*low, *high);
  // At a wall's end both ways lead down on one side at least.
  const bool is_end = 4 * std::max(foot_x, foot_y) < *s;
  const bool across_x = is_end ? *left + *right <= *low + *high : foot_x <= foot_y;
  const std::ptrdiff_t step = across_x ? 1 : kSide;
  if (!is_crest(s, step)) return std::nullopt;
  const float off = offset_of_top(s, step);
  return across_x ? Eigen::Vector2f(off, 0.0F) : Eigen::Vector2f(0.0F, off);
}

std::uint64_t& word_at(CellBitmap& bits, CellIndex first) {
  return bits.row(first.y - bits.first().y)[(first.x >> kChunkBits) - bits.box().min.x];
}

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

/// Fills in what a chunk without any hits around says: free where there are misses.
void read_empty_chunk(const Chunk& chunk, CellIndex first, Sight& sight) {
  std::uint8_t seen[kChunkSide];
  for (int y = 0; y < kChunkSide; ++y) {
    for (int x = 0; x < kChunkSide; ++x) seen[x] = chunk.miss[y][x] > 0;
    word_at(sight.seen_through, {first.x, first.y + y}) = packed(seen);
  }
}

void read_row(const SmoothChunk& smooth, const Chunk& chunk, int y, CellIndex first, Sight& sight) {
  const std::uint8_t *hit = chunk.hit[y], *miss = chunk.miss[y];
  const std::uint16_t* s = &smooth.at(0, y);
  std::uint8_t seen[kChunkSide], thick[kChunkSide], doubtful[kChunkSide], surface[kChunkSide],
      faint[kChunkSide];
  for (int x = 0; x < kChunkSide; ++x) {
    seen[x] = (miss[x] > 0) & (miss[x] >= hit[x]);
    thick[x] = hit[x] > miss[x];
    doubtful[x] = s[x] >= kDoubtfulHits;
    surface[x] = is_surface(s[x], hit[x], miss[x]);
    faint[x] = (s[x] >= kLeastFaintHits) & (s[x] >= kFaintHitsPerMiss * miss[x]);
  }
  std::uint64_t crest = 0;
  for (std::uint64_t left = packed(faint); left != 0; left &= left - 1) {
    const int x = std::countr_zero(left);
    if (const auto c = crest_at(s + x)) {
      crest |= std::uint64_t{1} << x;
      sight.crests.push_back({{first.x + x, first.y}, c->x(), c->y(), hit[x]});
    }
  }
  word_at(sight.crest, first) = crest & packed(surface);
  word_at(sight.faint, first) = crest;
  word_at(sight.seen_through, first) = packed(seen);
  word_at(sight.thick, first) = packed(thick);
  word_at(sight.doubtful, first) = packed(doubtful) & packed(seen);
}

/// Sixteen directions, and in which of them there are crests no farther than kFaintReach, a bit each.
std::uint32_t directions_of_crests(const CellBitmap& crest, CellIndex at) {
  static const auto kDirections = [] {
    std::array<std::uint16_t, (2 * kFaintReach + 1) * (2 * kFaintReach + 1)> table{};
    std::size_t i = 0;
    for (int dy = -kFaintReach; dy <= kFaintReach; ++dy) {
      for (int dx = -kFaintReach; dx <= kFaintReach; ++dx, ++i) {
        const auto direction = std::lround(std::atan2(dy, dx) * (16 / kTwoPi));
        table[i] = static_cast<std::uint16_t>(dx == 0 && dy == 0 ? 0 : 1U << (direction & 15));
      }
    }
    return table;
  }();
  std::uint32_t found = 0;
  std::size_t i = 0;
  for (int dy = -kFaintReach; dy <= kFaintReach; ++dy) {
    for (int dx = -kFaintReach; dx <= kFaintReach; ++dx, ++i) {
      if (crest.test({at.x + dx, at.y + dy})) found |= kDirections[i];
    }
  }
  return found;
}

/// Whether two of the directions are more than a right angle apart. (A cell beside a straight wall sees a
/// right angle of it.)
bool are_on_both_sides(std::uint32_t directions) {
  const std::uint32_t twice = directions | directions << 16;
  bool any = false;
  for (int turn = 5; turn <= 8; ++turn) any = any || (directions & twice >> turn) != 0;
  return any;
}

/// Makes surfaces of the faint crests that lie between clear ones. No rows of them grow out into the open.
void bridge_gaps(Sight& sight) {
  std::vector<CellIndex> between;
  for (const Crest& c : sight.crests) {
    if (!sight.crest.test(c.cell) && are_on_both_sides(directions_of_crests(sight.crest, c.cell)))
      between.push_back(c.cell);
  }
  for (const CellIndex c : between) sight.crest.set(c);
}

}  // namespace

Sight sight_of(const ChunkedGrid& grid) {
  Sight sight;
  for (CellBitmap* b : {&sight.crest, &sight.faint, &sight.seen_through, &sight.thick, &sight.doubtful})
    b->reset(grid.box());
  SmoothChunk smooth;
  for (std::int32_t cy = grid.box().min.y; cy <= grid.box().max.y; ++cy) {
    for (std::int32_t cx = grid.box().min.x; cx <= grid.box().max.x; ++cx) {
      const Chunk* chunk = grid.find({cx, cy});
      if (!chunk) continue;
      const CellIndex first = first_cell({cx, cy});
      if (!smooth.load(grid, {cx, cy})) {
        read_empty_chunk(*chunk, first, sight);
        continue;
      }
      for (int y = 0; y < kChunkSide; ++y) read_row(smooth, *chunk, y, {first.x, first.y + y}, sight);
    }
  }
  bridge_gaps(sight);
  for (CellBitmap* b : {&sight.seen_through, &sight.thick, &sight.doubtful}) take_out(*b, sight.crest);
  return sight;
}

}  // namespace dynslam
