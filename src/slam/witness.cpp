// SPDX-License-Identifier: MIT
#include "slam/witness.h"

#include <bit>
#include <cmath>

#include "grid/bitmap_sets.h"

namespace dynslam {
namespace {

constexpr int kRim = 4;  ///< cells around a block that its shadows depend on

/// 64 x 64 cells of a finished map around a block, out of the tiles and in one place. 32 cells on the
/// diagonal and the rim fit in.
class Patch {
 public:
  Patch(const FinishedMap& map, CellIndex low, int rows) : rows_(rows) {
    const auto n = static_cast<std::size_t>(rows);
    map.free.words(low, {free_.data(), n});
    map.occupied.words(low, {occupied_.data(), n});
    for (std::size_t r = 0; r < n; ++r) {
      any_ |= free_[r] | occupied_[r];
      any_occupied_ |= occupied_[r];
    }
    if (any_occupied_ == 0) return;
    // An older surface beside a newer one, within two cells, is the same. Past its end it goes on.
    CellBitmap surface;
    surface.reset({{0, 0}, {0, 0}});
    surface.put({0, 0}, occupied_);
    shadow_ = grown_across(surface).tile({0, 0});
    near_ = occupied_;
    grow_near();
    grow_near();
  }

  bool is_empty() const { return any_ == 0; }
  bool is_free(int x, int y) const { return (free_[static_cast<std::size_t>(y)] >> x & 1U) != 0; }
  bool is_occupied(int x, int y) const { return (occupied_[static_cast<std::size_t>(y)] >> x & 1U) != 0; }
  bool is_near(int x, int y) const { return (near_[static_cast<std::size_t>(y)] >> x & 1U) != 0; }
  bool is_in_shadow(int x, int y) const { return (shadow_[static_cast<std::size_t>(y)] >> x & 1U) != 0; }

 private:
  using Rows = std::array<std::uint64_t, 64>;

  void grow_near() {
    std::uint64_t below = 0;
    for (std::size_t r = 0; r < static_cast<std::size_t>(rows_); ++r) {
      const std::uint64_t here = near_[r];
      const std::uint64_t above = r + 1 < static_cast<std::size_t>(rows_) ? near_[r + 1] : 0;
      near_[r] = here | here << 1 | here >> 1 | below | above;
      below = here;
    }
  }

  int rows_;
  std::uint64_t any_ = 0, any_occupied_ = 0;
  Rows free_{}, occupied_{}, near_{}, shadow_{};
};

/// From cells of the block to cells of the patch, in 1/65536 of a cell.
class Turn {
 public:
  static constexpr int kBits = 16;

  Turn(double c, double s, double x0, double y0)
      : c_(fixed(c)), s_(fixed(s)), x0_(fixed(x0)), y0_(fixed(y0)) {
    for (std::size_t i = 0; i < off_x_.size(); ++i) {
      const double dx = i % 2 == 0 ? -0.25 : 0.25, dy = i / 2 == 0 ? -0.25 : 0.25;
      off_x_[i] = fixed(c * dx - s * dy);
      off_y_[i] = fixed(s * dx + c * dy);
    }
  }

  struct Place {
    std::int32_t x, y;
  };
  Place middle(int x, int y) const { return {x0_ + x * c_ - y * s_, y0_ + x * s_ + y * c_}; }
  bool touches_surface(const Patch& patch, Place p) const {
    bool any = false;
    for (std::size_t i = 0; i < off_x_.size(); ++i)
      any = any || patch.is_occupied((p.x + off_x_[i]) >> kBits, (p.y + off_y_[i]) >> kBits);
    return any;
  }

 private:
  static std::int32_t fixed(double v) { return static_cast<std::int32_t>(std::lround(v * (1 << kBits))); }

  std::int32_t c_, s_, x0_, y0_;
  std::array<std::int32_t, 4> off_x_{}, off_y_{};
};

/// Of the undecided cells of a row: free, occupied, and right beside a surface.
struct RowWord {
  std::uint32_t free = 0, occupied = 0, shadow = 0;
};

RowWord read_row(const Patch& patch, const Turn& turn, int y, std::uint32_t undecided) {
  RowWord word;
  for (std::uint32_t left = undecided; left != 0; left &= left - 1) {
    const int x = std::countr_zero(left);
    const std::uint32_t bit = std::uint32_t{1} << x;
    const Turn::Place at = turn.middle(x, y);
    const int px = at.x >> Turn::kBits, py = at.y >> Turn::kBits;
    const bool near = patch.is_near(px, py);
    if (near && turn.touches_surface(patch, at)) {
      word.occupied |= bit;
    } else if (patch.is_free(px, py)) {
      word.free |= bit;
    } else if (patch.is_in_shadow(px, py)) {
      word.shadow |= bit;
    }
  }
  return word;
}

}  // namespace

BlockView::BlockView(CellIndex first_cell, int side_cells) : first(first_cell), side(side_cells) {
  const std::uint32_t row = side == kMost ? ~std::uint32_t{0} : (std::uint32_t{1} << side) - 1;
  for (int y = 0; y < side; ++y) undecided[static_cast<std::size_t>(y)] = row;
}

bool BlockView::is_decided() const {
  std::uint32_t any = 0;
  for (const std::uint32_t row : undecided) any |= row;
  return any == 0;
}

Testimony hear(const FinishedMap& map, const Pose2& map_T_origin, BlockView& block) {
  const Pose2 drawn_T_map = map.drawn_T_origin * map_T_origin.inverse();
  const double c = std::cos(drawn_T_map.yaw), s = std::sin(drawn_T_map.yaw);
  const auto drawn_cell = [&](double x, double y) {
    return Vector2(drawn_T_map.x / map.cell_size_m + c * x - s * y,
                   drawn_T_map.y / map.cell_size_m + s * x + c * y);
  };
  const double half = 0.5 * block.side, reach = half * (std::abs(c) + std::abs(s)) + kRim;
  const Vector2 middle = drawn_cell(block.first.x + half, block.first.y + half);
  const CellIndex low = cell_at(middle - Vector2(reach, reach), 1.0);
  const Patch patch(map, low, static_cast<int>(2 * reach) + 2);
  Testimony testimony;
  if (patch.is_empty()) return testimony;
  const Vector2 first = drawn_cell(block.first.x + 0.5, block.first.y + 0.5);
  const Turn turn(c, s, first.x() - low.x, first.y() - low.y);
  for (int y = 0; y < block.side; ++y) {
    const auto i = static_cast<std::size_t>(y);
    if (block.undecided[i] == 0) continue;
    const RowWord word = read_row(patch, turn, y, block.undecided[i]);
    const std::uint32_t occupied = word.occupied & ~block.no_wall[i];
    block.free[i] |= word.free;
    block.occupied[i] |= occupied;
    block.no_wall[i] |= word.occupied | word.shadow;
    block.undecided[i] &= ~(word.free | occupied);
    testimony.free += std::popcount(word.free);
    testimony.occupied += std::popcount(occupied);
  }
  return testimony;
}

}  // namespace dynslam
