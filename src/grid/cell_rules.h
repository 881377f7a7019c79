// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>

#include "grid/cell_index.h"

/// How a cell learns and what it means: the one place that looks at the bytes (thesis 4.1.2, equations 4.4
/// and 4.5). Each cell has two bytes, hit and miss: 0 = never seen .. 255 = sure.
namespace dynslam {

/// What a look adds to the plane it speaks for, and takes from the other one.
struct CellRule {
  std::uint8_t gain = 26;  ///< ten looks make sure
  std::uint8_t loss = 13;
};

inline constexpr std::uint8_t kSureHit = 52;  ///< fewer hits than this may be noise

constexpr std::uint8_t raised(std::uint8_t value, std::uint8_t by) {
  return static_cast<std::uint8_t>(std::min<std::uint8_t>(value, static_cast<std::uint8_t>(255 - by)) + by);
}
constexpr std::uint8_t lowered(std::uint8_t value, std::uint8_t by) {
  return static_cast<std::uint8_t>(std::max(value, by) - by);
}

constexpr CellState cell_state(std::uint8_t hit, std::uint8_t miss) {
  if (hit > miss && hit >= kSureHit) return CellState::kOccupied;
  if (miss > 0 && miss >= hit) return CellState::kFree;
  return CellState::kUnknown;
}

}  // namespace dynslam
