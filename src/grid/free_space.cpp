// SPDX-License-Identifier: MIT
#include "grid/free_space.h"

#include <algorithm>
#include <cmath>

#include "grid/ray_walk.h"

namespace dynslam {
namespace {

/// The angle from one ray to the next in order of bearing, 0 to 2 pi; the last and the first meet at pi.
float wedge_between(const RayEnd& a, const RayEnd& b) {
  const float wedge = b.bearing_rad - a.bearing_rad;
  return wedge < 0 ? wedge + static_cast<float>(kTwoPi) : wedge;
}

/// Whether two rays next to each other end on one surface. Seen at a flat angle, a wall's ends lie several
/// arcs apart; a step of more than that, and of more than what noise makes, is an edge with something unseen
/// behind it.
bool on_one_surface(const RayEnd& a, const RayEnd& b) {
  const float step = std::abs(a.range_m - b.range_m);
  const float arc = std::min(a.range_m, b.range_m) * wedge_between(a, b);
  return step <= 0.1F + 3.0F * arc;
}

/// Whether the surface between two ends is as good as seen: they are more than a cell apart, and the line
/// between them is not so steep that it may be the edge of one thing before another.
bool is_surface_between(const RayEnd& a, const RayEnd& b, double max_wedge_rad, double cell_size_m) {
  constexpr float kLongest_m = 0.6F;
  const float wedge = wedge_between(a, b);
  if (wedge > max_wedge_rad) return false;
  const float step = std::abs(a.range_m - b.range_m);
  const float arc = std::min(a.range_m, b.range_m) * wedge;
  const float length = std::sqrt(step * step + arc * arc);
  return length > 1.5F * static_cast<float>(cell_size_m) && length < kLongest_m && step <= 0.03F + 3.0F * arc;
}

/// Bits from each toggle on: bit b of the result is the parity of bits 0..b.
std::uint64_t parity_up_to_each_bit(std::uint64_t word) {
  for (int shift = 1; shift < 64; shift *= 2) word ^= word << shift;
  return word;
}

}  // namespace

const ScanFootprint& FreeSpace::trace(const Pose2& grid_T_origin, std::span<const RayEnd> ends,
                                      double max_wedge_rad, double cell_size_m) {
  lone_.clear();
  place(grid_T_origin, ends, cell_size_m);
  outline(ends, max_wedge_rad);
  fill();
  for (const Corner end : lone_) walk_lone_ray(end);
  mark_hits(ends, max_wedge_rad, cell_size_m);
  return footprint_;
}

/// Moves the ends into the grid and makes the bitmaps large enough for them.
void FreeSpace::place(const Pose2& grid_T_origin, std::span<const RayEnd> ends, double cell_size_m) {
  const double c = std::cos(grid_T_origin.yaw) / cell_size_m, s = std::sin(grid_T_origin.yaw) / cell_size_m;
  const Vector2 origin = grid_T_origin.translation() / cell_size_m;
  double min_x = 0, max_x = 0, min_y = 0, max_y = 0;
  corners_.clear();
  for (const RayEnd& e : ends) {
    const double x = c * e.x_m - s * e.y_m, y = s * e.x_m + c * e.y_m;
    min_x = std::min(min_x, x), max_x = std::max(max_x, x);
    min_y = std::min(min_y, y), max_y = std::max(max_y, y);
    corners_.push_back({static_cast<float>(x), static_cast<float>(y)});
  }
  // Two cells of margin: the ring of cells around a hit, and the toggle one beyond the last cell of a row.
  const CellIndex low{static_cast<std::int32_t>(std::floor(origin.x() + min_x)) - 2,
                      static_cast<std::int32_t>(std::floor(origin.y() + min_y)) - 2};
  const CellIndex high{static_cast<std::int32_t>(std::floor(origin.x() + max_x)) + 2,
                       static_cast<std::int32_t>(std::floor(origin.y() + max_y)) + 2};
  const ChunkBox box{chunk_of(low), chunk_of(high)};
  footprint_.misses.reset(box);
  hit_bits_.reset(box);
  const CellIndex first = footprint_.misses.first();
  centre_ = {static_cast<float>(origin.x() - first.x), static_cast<float>(origin.y() - first.y)};
  for (Corner& corner : corners_) corner = {corner.x + centre_.x, corner.y + centre_.y};
}

/// Toggles, in each row whose middle the edge crosses, the first cell whose centre lies right of it. An edge
/// has its lower end and not its upper one, so that a corner between two edges counts once.
void FreeSpace::add_edge(Corner a, Corner b) {
  if (a.y > b.y) std::swap(a, b);
  const int begin = static_cast<int>(std::ceil(a.y - 0.5F));
  const int end = static_cast<int>(std::ceil(b.y - 0.5F));
  if (begin >= end) return;
  const float slope = (b.x - a.x) / (b.y - a.y);
  const float low = std::min(a.x, b.x), high = std::max(a.x, b.x);
  const int words = footprint_.misses.words_per_row();
  std::uint64_t* row = footprint_.misses.row(begin);
  for (int r = begin; r < end; ++r, row += words) {
    const float x = std::clamp(a.x + (static_cast<float>(r) + 0.5F - a.y) * slope, low, high);
    const auto column = static_cast<unsigned>(std::ceil(x - 0.5F));
    row[column >> kChunkBits] ^= std::uint64_t{1} << (column & kChunkMask);
  }
}

void FreeSpace::add_wedge(const RayEnd& a, const RayEnd& b, Corner corner_a, Corner corner_b) {
  if (on_one_surface(a, b)) return add_edge(corner_a, corner_b);
  // The surface breaks off: the far ray keeps its way, the wedge ends where the near one does.
  const bool a_is_near = a.range_m < b.range_m;
  const Corner far = a_is_near ? corner_b : corner_a;
  const float share = a_is_near ? a.range_m / b.range_m : b.range_m / a.range_m;
  const Corner cut{centre_.x + share * (far.x - centre_.x), centre_.y + share * (far.y - centre_.y)};
  add_edge(corner_a, cut);
  add_edge(cut, corner_b);
}

void FreeSpace::outline(std::span<const RayEnd> ends, double max_wedge_rad) {
  const std::size_t n = ends.size();
  if (n == 0) return;
  bool joined_before = false;  // to the ray on the right, on one surface
  bool first_joined = false;
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t j = i + 1 < n ? i + 1 : 0;
    const bool open = n == 1 || wedge_between(ends[i], ends[j]) > max_wedge_rad;
    if (open) {
      add_edge(corners_[i], centre_);
      add_edge(centre_, corners_[j]);
    } else {
      add_wedge(ends[i], ends[j], corners_[i], corners_[j]);
    }
    const bool joined = !open && on_one_surface(ends[i], ends[j]);
    if (i == 0) first_joined = joined;
    if (i > 0 && !joined_before && !joined) lone_.push_back(corners_[i]);
    joined_before = joined;
  }
  if (n == 1 || (!joined_before && !first_joined)) lone_.push_back(corners_[0]);
}

void FreeSpace::fill() {
  CellBitmap& misses = footprint_.misses;
  for (int r = 0; r < misses.rows(); ++r) {
    std::uint64_t* row = misses.row(r);
    std::uint64_t inside = 0;  // all ones where the word before ended inside
    for (int w = 0; w < misses.words_per_row(); ++w) {
      row[w] = row[w] == 0 ? inside : parity_up_to_each_bit(row[w]) ^ inside;
      inside = (row[w] >> 63) != 0 ? ~std::uint64_t{0} : 0;
    }
  }
}

void FreeSpace::walk_lone_ray(Corner end) {
  const CellIndex first = footprint_.misses.first();
  walk_ray({centre_.x, centre_.y}, {end.x, end.y}, 1.0, [&](CellIndex c) {
    footprint_.misses.set({c.x + first.x, c.y + first.y});
  });
}

/// Notes a hit cell once, and takes it and its ring out of the misses: rays that graze a wall would eat it.
/// The bitmap's margin holds the ring.
void FreeSpace::mark_hit(CellIndex c) {
  if (hit_bits_.test(c)) return;
  hit_bits_.set(c);
  footprint_.hits.push_back(c);
  CellBitmap& misses = footprint_.misses;
  const int column = c.x - misses.first().x, bit = column & kChunkMask;
  for (int r = c.y - misses.first().y - 1; r <= c.y - misses.first().y + 1; ++r) {
    std::uint64_t* word = misses.row(r) + (column >> kChunkBits);
    *word &= ~(bit > 0 ? std::uint64_t{7} << (bit - 1) : std::uint64_t{3});
    if (bit == 0) word[-1] &= ~(std::uint64_t{1} << kChunkMask);
    if (bit == kChunkMask) word[1] &= ~std::uint64_t{1};
  }
}

/// The cells of the ends and, where two rays next to each other clearly ended on one surface, of the surface
/// between.
void FreeSpace::mark_hits(std::span<const RayEnd> ends, double max_wedge_rad, double cell_size_m) {
  const CellIndex first = hit_bits_.first();
  footprint_.hits.clear();
  for (std::size_t i = 0; i < ends.size(); ++i) {
    if (!ends[i].hit) continue;
    const std::size_t j = i + 1 < ends.size() ? i + 1 : 0;
    if (ends[j].hit && is_surface_between(ends[i], ends[j], max_wedge_rad, cell_size_m)) {
      walk_ray({corners_[i].x, corners_[i].y}, {corners_[j].x, corners_[j].y}, 1.0, [&](CellIndex c) {
        mark_hit({c.x + first.x, c.y + first.y});
      });
    } else {
      mark_hit({first.x + floor_to_int(corners_[i].x), first.y + floor_to_int(corners_[i].y)});
    }
  }
}

}  // namespace dynslam
