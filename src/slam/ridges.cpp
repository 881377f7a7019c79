// SPDX-License-Identifier: MIT
#include "slam/ridges.h"

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <cstring>

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

void find_in_chunk(const SmoothChunk& smooth, const Chunk& chunk, ChunkIndex index, std::vector<Crest>& crests) {
  const CellIndex first = first_cell(index);
  for (int y = 0; y < kChunkSide; ++y) {
    for (int x = 0; x < kChunkSide; ++x) {
      const std::uint16_t* s = &smooth.at(x, y);
      if (!is_surface(*s, chunk.hit[y][x], chunk.miss[y][x])) continue;
      // The wall runs along the other axis than the one on which the hits fall off faster.
      const bool across_x = s[-2] + s[2] <= s[-2 * kSide] + s[2 * kSide];
      const std::ptrdiff_t step = across_x ? 1 : kSide;
      if (!is_crest(s, step)) continue;
      const float off = offset_of_top(s, step);
      crests.push_back({.cell = {first.x + x, first.y + y},
                        .dx = across_x ? off : 0.0F,
                        .dy = across_x ? 0.0F : off,
                        .hit = chunk.hit[y][x]});
    }
  }
}

}  // namespace

std::vector<Crest> find_crests(const ChunkedGrid& grid) {
  std::vector<Crest> crests;
  SmoothChunk smooth;
  for (std::int32_t y = grid.box().min.y; y <= grid.box().max.y; ++y) {
    for (std::int32_t x = grid.box().min.x; x <= grid.box().max.x; ++x) {
      const Chunk* chunk = grid.find({x, y});
      if (chunk && smooth.load(grid, {x, y})) find_in_chunk(smooth, *chunk, {x, y}, crests);
    }
  }
  return crests;
}

}  // namespace dynslam
