// SPDX-License-Identifier: MIT
#pragma once

#include <compare>
#include <cstdint>

#include <Eigen/Core>

namespace dynslam {

/// A cell of a grid: covers [x, x + 1) by [y, y + 1) cells from the frame's origin, y up.
struct CellIndex {
  std::int32_t x = 0;
  std::int32_t y = 0;
  auto operator<=>(const CellIndex&) const = default;
};

/// What a map says of a cell.
enum class CellState : std::uint8_t { kUnknown, kFree, kOccupied };

/// The whole number at or below, for numbers within 2^31; without a call into the library, as std::floor is
/// on older processors.
inline std::int32_t floor_to_int(double v) {
  const auto towards_zero = static_cast<std::int32_t>(v);
  return towards_zero - (v < towards_zero ? 1 : 0);
}

/// The cell that holds a point. The point must lie within 2^31 cells of the origin.
inline CellIndex cell_at(const Eigen::Vector2d& point_m, double cell_size_m) {
  return {floor_to_int(point_m.x() / cell_size_m), floor_to_int(point_m.y() / cell_size_m)};
}

/// The middle of a cell, in metres.
inline Eigen::Vector2d cell_centre(CellIndex c, double cell_size_m) {
  return {(c.x + 0.5) * cell_size_m, (c.y + 0.5) * cell_size_m};
}

}  // namespace dynslam
