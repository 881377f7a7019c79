// SPDX-License-Identifier: MIT
#include "slam/max_pyramid.h"

#include <bit>
#include <cmath>
#include <limits>
#include <utility>

namespace dynslam {
namespace {

/// Width of the ridge that a surface becomes, in base cells: half a cell off still scores three quarters.
constexpr double kRidgeSigma = 0.7;
/// Samples along the side of a base cell that decide whether it is free.
constexpr int kSamples = 2;

/// Height of the ridge so many base cells off.
double ridge(double off) { return std::exp(-off * off / (2 * kRidgeSigma * kRidgeSigma)); }

bool is_finite(const CloudPoint& p) { return std::isfinite(p.x_m) && std::isfinite(p.y_m); }

struct Extent {
  Vector2 low = Vector2::Constant(std::numeric_limits<double>::infinity());
  Vector2 high = -low;
  void include(const Vector2& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
};

/// The free cells' extent, from both ends of each row.
void include_free(const FinishedMap& map, Extent& extent) {
  const Pose2 origin_T_drawn = map.drawn_T_origin.inverse();
  for (int r = 0; r < map.free.rows(); ++r) {
    const std::uint64_t* row = map.free.row(r);
    int left = -1, right = -1;
    for (int w = 0; w < map.free.words_per_row(); ++w) {
      if (row[w] == 0) continue;
      if (left < 0) left = w * kChunkSide + std::countr_zero(row[w]);
      right = w * kChunkSide + kChunkSide - 1 - std::countl_zero(row[w]);
    }
    if (left < 0) continue;
    for (const int x : {left, right}) {
      const CellIndex cell{map.free.first().x + x, map.free.first().y + r};
      extent.include(origin_T_drawn * cell_centre(cell, map.cell_size_m));
    }
  }
}

}  // namespace

MaxPyramid::MaxPyramid(const FinishedMap& map, const MaxPyramidConfig& config)
    : cell_size_m_(std::max(config.least_cell_m, config.map_cells * map.cell_size_m)),
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
  Extent extent;
  for (const CloudPoint& p : map.cloud) {
    if (is_finite(p)) extent.include({p.x_m, p.y_m});
  }
  include_free(map, extent);
  int width = 0, height = 0;
  if (extent.low.x() <= extent.high.x()) {
    const CellIndex low = cell_at(extent.low, cell_size_m_), high = cell_at(extent.high, cell_size_m_);
    first_ = {low.x - 1, low.y - 1};  // a surface reaches into the cells around it
    width = high.x - low.x + 3;
    height = high.y - low.y + 3;
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

/// A base cell is free when most of it is.
void MaxPyramid::draw_free(const FinishedMap& map) {
  constexpr int kBias = 1 << 24;  // of what is cut off below: truncation is then floor
  Plane& base = planes_[0];
  const double scale = cell_size_m_ / map.cell_size_m;  // from here on in cells of the map
  const double c = scale * std::cos(map.drawn_T_origin.yaw), s = scale * std::sin(map.drawn_T_origin.yaw);
  const double x0 = map.drawn_T_origin.x / map.cell_size_m + kBias,
               y0 = map.drawn_T_origin.y / map.cell_size_m + kBias;
  for (int y = 0; y < base.height; ++y) {
    for (int x = 0; x < base.width; ++x) {
      int free = 0;
      for (int k = 0; k < kSamples * kSamples; ++k) {
        const double px = first_.x + x + (k % kSamples + 0.5) / kSamples,
                     py = first_.y + y + (k / kSamples + 0.5) / kSamples;
        const CellIndex drawn{static_cast<int>(x0 + c * px - s * py) - kBias,
                              static_cast<int>(y0 + s * px + c * py) - kBias};
        free += map.free.test(drawn) ? 1 : 0;
      }
      if (2 * free <= kSamples * kSamples) continue;
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
    if (!is_finite(p)) continue;
    const double px = p.x_m / cell_size_m_ - first_.x, py = p.y_m / cell_size_m_ - first_.y;
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
    if (!is_finite(p)) continue;
    const CellIndex at = cell_of({p.x_m, p.y_m});
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
