// SPDX-License-Identifier: MIT
#include "slam/max_pyramid.h"

#include <bit>
#include <cmath>
#include <utility>

namespace dynslam {
namespace {

/// Width of the ridge that a surface becomes, in base cells: half a cell off still scores three quarters.
constexpr double kRidgeSigma = 0.7;
/// Height of the ridge so many base cells off.
double ridge(double off) { return std::exp(-off * off / (2 * kRidgeSigma * kRidgeSigma)); }

Vector2 drawn_position(const FinishedMap& map, const CloudPoint& p) {
  return map.drawn_T_origin * Vector2(p.x_m, p.y_m);
}

}  // namespace

MaxPyramid::MaxPyramid(const FinishedMap& map, const MaxPyramidConfig& config)
    : map_cells_(std::max(config.least_map_cells,
                          static_cast<int>(std::ceil(config.least_cell_m / map.cell_size_m - 1e-9)))),
      cell_size_m_(map_cells_ * map.cell_size_m),
      unknown_worth_(config.unknown_worth),
      planes_(kLevels) {
  measure(map);
  if (width() == 0) return;
  draw_free(map);
  draw_surfaces(map);
  clear_around_surfaces(map, config.clear_m);
  stack();
}

/// Makes room for all that the map knows, with all of it unknown.
void MaxPyramid::measure(const FinishedMap& map) {
  const auto base = [&](std::int32_t cell) {
    return static_cast<std::int32_t>(std::floor(static_cast<double>(cell) / map_cells_));
  };
  int width = 0, height = 0;
  const CellBox free = map.free.bounds(), occupied = map.occupied.bounds();
  if (!free.empty() || !occupied.empty()) {
    const CellBox& a = free.empty() ? occupied : free;
    const CellBox& b = occupied.empty() ? free : occupied;
    // A surface reaches into the cells around it.
    first_ = {base(std::min(a.min.x, b.min.x)) - 2, base(std::min(a.min.y, b.min.y)) - 2};
    width = base(std::max(a.max.x, b.max.x)) - first_.x + 3;
    height = base(std::max(a.max.y, b.max.y)) - first_.y + 3;
    const ChunkBox box{{0, 0}, chunk_of({width - 1, height - 1})};
    known_.reset(box);
    clear_.reset(box);
  }
  for (int level = 0; level < kLevels; ++level) {
    Plane& p = planes_[static_cast<std::size_t>(level)];
    const int side = 1 << level;
    p.width = (width + side - 1) / side;
    p.height = (height + side - 1) / side;
    p.bytes.assign(
        static_cast<std::size_t>(p.stride()) * static_cast<std::size_t>(p.height + Plane::kBelow + 1),
        unknown_worth_);
  }
}

/// Adds the free cells of a row of the map to the base cells that they lie in.
void MaxPyramid::count_free(const FinishedMap& map, std::int32_t map_row,
                            std::vector<std::uint8_t>& free) const {
  const std::int32_t left = first_.x * map_cells_, right = left + width() * map_cells_;
  for (std::int32_t x = left; x < right; x += kChunkSide) {
    for (std::uint64_t bits = map.free.word({x, map_row}); bits != 0; bits &= bits - 1) {
      const auto base = static_cast<std::size_t>((x - left + std::countr_zero(bits)) / map_cells_);
      if (base < free.size()) ++free[base];
    }
  }
}

/// A base cell is free when most of it is.
void MaxPyramid::draw_free(const FinishedMap& map) {
  Plane& base = planes_[0];
  std::vector<std::uint8_t> free(static_cast<std::size_t>(base.width));
  for (int y = 0; y < base.height; ++y) {
    std::fill(free.begin(), free.end(), std::uint8_t{0});
    for (int i = 0; i < map_cells_; ++i) count_free(map, (first_.y + y) * map_cells_ + i, free);
    for (int x = 0; x < base.width; ++x) {
      if (2 * free[static_cast<std::size_t>(x)] <= map_cells_ * map_cells_) continue;
      base.bytes[static_cast<std::size_t>(base.offset(x, y))] = 0;
      known_.set({x, y});
      clear_.set({x, y});
    }
  }
}

/// Each point raises the nine cells around it by how near their middles are.
void MaxPyramid::draw_surfaces(const FinishedMap& map) {
  Plane& base = planes_[0];
  for (const CloudPoint& p : map.cloud) {
    const Vector2 at = drawn_position(map, p) / cell_size_m_;
    const double px = at.x() - first_.x, py = at.y() - first_.y;
    if (!(px >= 1 && py >= 1 && px < base.width - 1 && py < base.height - 1)) continue;
    const int x0 = static_cast<int>(px), y0 = static_cast<int>(py);
    known_.set({x0, y0});
    for (int i = 0; i < 3; ++i) {
      const double in_row = ridge(y0 - 0.5 + i - py);
      for (int k = 0; k < 3; ++k) {
        const double near = in_row * ridge(x0 - 0.5 + k - px);
        std::uint8_t& byte = base.bytes[static_cast<std::size_t>(base.offset(x0 - 1 + k, y0 - 1 + i))];
        byte = std::max(byte, static_cast<std::uint8_t>(255 * near + 0.5));
      }
    }
  }
}

/// What is left of the free cells is clear of surfaces; what lies on their ridges is known.
void MaxPyramid::clear_around_surfaces(const FinishedMap& map, double clear_m) {
  const int reach = static_cast<int>(std::ceil(clear_m / cell_size_m_));
  const double reach2 = clear_m * clear_m / (cell_size_m_ * cell_size_m_);
  std::vector<std::uint8_t> done(planes_[0].bytes.size(), 0);
  for (const CloudPoint& p : map.cloud) {
    if (!std::isfinite(p.x_m) || !std::isfinite(p.y_m)) continue;
    const CellIndex at = cell_of(drawn_position(map, p));
    if (std::exchange(done[static_cast<std::size_t>(planes_[0].offset(at.x, at.y))], 1) != 0) continue;
    for (int dy = -reach; dy <= reach; ++dy) {
      for (int dx = -reach; dx <= reach; ++dx) {
        const CellIndex c{at.x + dx, at.y + dy};
        if (c.x < 0 || c.y < 0 || c.x >= width() || c.y >= height()) continue;
        if (dx * dx + dy * dy <= reach2) clear_.clear(c);
        if (dx * dx + dy * dy <= 1) known_.set(c);
      }
    }
  }
}

void MaxPyramid::stack() {
  for (std::size_t k = 1; k < planes_.size(); ++k) {
    const Plane& below = planes_[k - 1];
    Plane& here = planes_[k];
    for (int y = -1; y < here.height; ++y) {
      for (int x = -1; x < here.width; ++x) {
        std::uint8_t most = 0;
        for (int r = 2 * y; r <= 2 * y + 2; ++r) {
          for (int c = 2 * x; c <= 2 * x + 2; ++c) {
            most = std::max(most, below.bytes[static_cast<std::size_t>(below.offset(c, r))]);
          }
        }
        here.bytes[static_cast<std::size_t>(here.offset(x, y))] = most;
      }
    }
  }
}

std::size_t MaxPyramid::bytes() const {
  std::size_t n = 0;
  for (const Plane& p : planes_) n += p.bytes.size();
  for (const CellBitmap* b : {&known_, &clear_}) {
    n += static_cast<std::size_t>(b->rows()) * static_cast<std::size_t>(b->words_per_row()) * 8;
  }
  return n;
}

}  // namespace dynslam
