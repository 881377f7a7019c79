// SPDX-License-Identifier: MIT
#include "slam/max_pyramid.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "grid/spread_bits.h"

namespace dynslam {
namespace {

/// Width of the ridge that a surface becomes, in base cells: half a cell off still scores three quarters.
constexpr double kRidgeSigma = 0.7;
/// Height of the ridge so many base cells off.
double ridge(double off) { return std::exp(-off * off / (2 * kRidgeSigma * kRidgeSigma)); }

/// How often the side of a map cell is doubled to be so many cells long, or more; once at least, three times
/// at most.
int halvings_for(double cells) {
  return std::clamp(static_cast<int>(std::ceil(std::log2(cells) - 1e-9)), 1, 3);
}

/// The even bits, moved together.
std::uint64_t even_bits(std::uint64_t w) {
  w &= 0x5555555555555555ULL;
  w = (w | w >> 1) & 0x3333333333333333ULL;
  w = (w | w >> 2) & 0x0F0F0F0F0F0F0F0FULL;
  w = (w | w >> 4) & 0x00FF00FF00FF00FFULL;
  w = (w | w >> 8) & 0x0000FFFF0000FFFFULL;
  return (w | w >> 16) & 0x00000000FFFFFFFFULL;
}

/// Of each two by two bits of two rows: whether three are set at least.
std::uint64_t three_of_four(std::uint64_t low, std::uint64_t high) {
  const std::uint64_t both = (low & high) & (low >> 1 | high >> 1),
                      pair = (low >> 1 & high >> 1) & (low | high);
  return even_bits(both | pair);
}

/// A row of words of a bitmap `halvings` times halved, from the (halved) cell `first` on.
void halve(const TiledBitmap& cells, CellIndex first, int halvings, std::vector<std::uint64_t>& row) {
  if (halvings == 0) {
    for (std::size_t w = 0; w < row.size(); ++w)
      row[w] = cells.word({first.x + static_cast<std::int32_t>(w) * kChunkSide, first.y});
    return;
  }
  std::vector<std::uint64_t> low(2 * row.size()), high(low.size());
  halve(cells, {2 * first.x, 2 * first.y}, halvings - 1, low);
  halve(cells, {2 * first.x, 2 * first.y + 1}, halvings - 1, high);
  for (std::size_t w = 0; w < row.size(); ++w) {
    row[w] = three_of_four(low[2 * w], high[2 * w]) | three_of_four(low[2 * w + 1], high[2 * w + 1])
                                                          << (kChunkSide / 2);
  }
}

void clear_bytes(std::uint64_t chosen, std::uint8_t* bytes, int n) {
  std::uint64_t eight = 0;
  std::memcpy(&eight, bytes, static_cast<std::size_t>(n));
  eight &= ~chosen;
  std::memcpy(bytes, &eight, static_cast<std::size_t>(n));
}

/// Of the cells from `first` on, the maxima over the rows 2 y to 2 y + 2.
void most_of_three_rows(const MaxPyramid::Plane& plane, int y, int first, std::vector<std::uint8_t>& most) {
  const std::uint8_t* row[3];
  for (int i = 0; i < 3; ++i) row[i] = &plane.bytes[static_cast<std::size_t>(plane.offset(first, 2 * y + i))];
  for (std::size_t x = 0; x < most.size(); ++x) most[x] = std::max(std::max(row[0][x], row[1][x]), row[2][x]);
}

}  // namespace

MaxPyramid::MaxPyramid(const FinishedMap& map, const MaxPyramidConfig& config)
    : map_cell_bits_(halvings_for(config.least_cell_m / map.cell_size_m)),
      cell_size_m_((1 << map_cell_bits_) * map.cell_size_m),
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
  const auto base = [&](std::int32_t cell) { return cell >> map_cell_bits_; };
  int width = 0, height = 0;
  const CellBox free = map.free.bounds(), occupied = map.occupied.bounds();
  if (!free.empty() || !occupied.empty()) {
    const CellBox& a = free.empty() ? occupied : free;
    const CellBox& b = occupied.empty() ? free : occupied;
    // A surface reaches into the cells around it. Words begin with chunks: so they are read as they are kept.
    const int margin = 2 << map_cell_bits_;
    first_ = {base((std::min(a.min.x, b.min.x) - margin) & ~kChunkMask),
              base(std::min(a.min.y, b.min.y) - margin)};
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

/// A base cell is free when most of it is: three of four cells, and again for each further halving.
void MaxPyramid::draw_free(const FinishedMap& map) {
  const auto words = static_cast<std::size_t>(known_.words_per_row());
  std::vector<std::uint64_t> free(words);
  for (int y = 0; y < height(); ++y) {
    halve(map.free, {first_.x, first_.y + y}, map_cell_bits_, free);
    std::copy(free.begin(), free.end(), known_.row(y));
    std::copy(free.begin(), free.end(), clear_.row(y));
    std::uint8_t* const bytes = &planes_[0].bytes[static_cast<std::size_t>(planes_[0].offset(0, y))];
    for (int x = 0; x < width(); x += 8) {
      const std::uint64_t eight = free[static_cast<std::size_t>(x / kChunkSide)] >> (x % kChunkSide) & 0xFF;
      clear_bytes(kSpreadBits[eight], bytes + x, std::min(8, width() - x));
    }
  }
}

/// In base cells; nothing for what is not a number, or not well inside.
std::optional<Vector2> MaxPyramid::base_position(const FinishedMap& map, const CloudPoint& p) const {
  const Vector2 at = map.drawn_T_origin * Vector2(p.x_m, p.y_m) / cell_size_m_ - Vector2(first_.x, first_.y);
  const bool inside = at.x() >= 1 && at.y() >= 1 && at.x() < width() - 1 && at.y() < height() - 1;
  return inside ? std::optional(at) : std::nullopt;
}

/// Each point raises the nine cells around it by how near their middles are.
void MaxPyramid::draw_surfaces(const FinishedMap& map) {
  Plane& base = planes_[0];
  for (const CloudPoint& p : map.cloud) {
    const auto at = base_position(map, p);
    if (!at) continue;
    const double px = at->x(), py = at->y();
    const int x0 = static_cast<int>(px), y0 = static_cast<int>(py);
    known_.set({x0, y0});
    double in_row[3], in_column[3];
    for (int i = 0; i < 3; ++i) {
      in_row[i] = ridge(y0 - 0.5 + i - py);
      in_column[i] = ridge(x0 - 0.5 + i - px);
    }
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) {
        const double near = in_row[i] * in_column[k];
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
    const auto position = base_position(map, p);
    if (!position) continue;
    const CellIndex at{static_cast<int>(position->x()), static_cast<int>(position->y())};
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

/// Each cell from the nine below it: first down the columns, then along the row.
void MaxPyramid::stack() {
  std::vector<std::uint8_t> column;
  for (std::size_t k = 1; k < planes_.size(); ++k) {
    const Plane& below = planes_[k - 1];
    Plane& here = planes_[k];
    const int first = -2, columns = 2 * here.width + 3;
    column.resize(static_cast<std::size_t>(columns));
    for (int y = -1; y < here.height; ++y) {
      most_of_three_rows(below, y, first, column);
      std::uint8_t* out = &here.bytes[static_cast<std::size_t>(here.offset(-1, y))];
      for (int x = 0; x <= here.width; ++x) {
        const std::uint8_t* in = &column[static_cast<std::size_t>(2 * x)];
        out[x] = std::max(std::max(in[0], in[1]), in[2]);
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
