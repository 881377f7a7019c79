// SPDX-License-Identifier: MIT
#include "slam/map_sight.h"

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <cstring>
#include <optional>

namespace dynslam {
namespace {

inline int P(const char* n, int d) { const char* v = std::getenv(n); return v ? std::atoi(v) : d; }

constexpr int kReach = 2;                            ///< cells, of the smoothing and of the comparison each
constexpr int kRim = 2 * kReach;
constexpr int kSide = kChunkSide + 2 * kRim;

/// The hits of a chunk and of a rim around it, and the same smoothed by the binomial 1 4 6 4 1 both ways. A
/// wall drawn twice, up to two cells apart, has one crest in it.
class SmoothChunk {
 public:
  /// False when there are no hits.
  bool load(const ChunkedGrid& grid, ChunkIndex index);
  /// Smoothed hits, 0 to 256 * 255; for cells no more than kReach outside of the chunk.
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
      along_[y][x] =
          static_cast<std::uint16_t>(h[x - 2] + h[x + 2] + 4 * (h[x - 1] + h[x + 1]) + 6 * h[x]);
    }
  }
  for (int y = kReach; y < kSide - kReach; ++y) {
    for (int x = kReach; x < kSide - kReach; ++x) {
      smooth_[y][x] = static_cast<std::uint16_t>(along_[y - 2][x] + along_[y + 2][x] +
                                                 4 * (along_[y - 1][x] + along_[y + 1][x]) + 6 * along_[y][x]);
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
  return bend <= 0 ? 0.0F : std::clamp(0.5F * static_cast<float>(after - before) / static_cast<float>(bend), -0.5F, 0.5F);
}

/// Whether the hits of a cell stand for a surface.
bool is_surface(std::uint16_t smoothed, std::uint8_t hit, std::uint8_t miss) {
  static const int least = P("LEAST", 12) * 256, lh = P("LEASTHIT", 0), num = P("NUM", 1), den = P("DEN", 8);
  return smoothed >= least && hit >= lh && den * hit >= num * miss;
}

/// From the middle of a cell to the top of the crest over it, in cells; nothing where it is not under one.
/// The wall runs along the axis on which the hits fall off slower.
std::optional<Eigen::Vector2f> crest_at(const std::uint16_t* s) {
  const bool across_x = s[-kReach] + s[kReach] <= s[-kReach * kSide] + s[kReach * kSide];
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
  static const int doubt = P("DOUBT", 48) * 16;
  const std::uint8_t *hit = chunk.hit[y], *miss = chunk.miss[y];
  const std::uint16_t* s = &smooth.at(0, y);
  std::uint8_t seen[kChunkSide], thick[kChunkSide], doubtful[kChunkSide], surface[kChunkSide];
  for (int x = 0; x < kChunkSide; ++x) {
    seen[x] = (miss[x] > 0) & (miss[x] >= hit[x]);
    thick[x] = hit[x] > miss[x];
    doubtful[x] = s[x] >= doubt;
    surface[x] = is_surface(s[x], hit[x], miss[x]);
  }
  std::uint64_t crest = 0;
  for (std::uint64_t left = packed(surface); left != 0; left &= left - 1) {
    const int x = std::countr_zero(left);
    if (const auto c = crest_at(s + x)) {
      crest |= std::uint64_t{1} << x;
      sight.crests.push_back({{first.x + x, first.y}, c->x(), c->y(), hit[x]});
    }
  }
  word_at(sight.crest, first) = crest;
  word_at(sight.seen_through, first) = packed(seen) & ~crest;
  word_at(sight.thick, first) = packed(thick) & ~crest;
  word_at(sight.doubtful, first) = packed(doubtful) & packed(seen) & ~crest;
}

}  // namespace

Sight sight_of(const ChunkedGrid& grid) {
  Sight sight;
  for (CellBitmap* b : {&sight.crest, &sight.seen_through, &sight.thick, &sight.doubtful}) b->reset(grid.box());
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
  return sight;
}

}  // namespace dynslam
