// SPDX-License-Identifier: MIT
#include "io/wall_runs.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace dynslam {
namespace {

constexpr double kRimShare = 0.002;  // of the occupied cells, on each of the four sides

/// Marks the blocks of the row of blocks whose highest row of cells is `top`.
void mark_walls(const TrinaryMap& map, int top, int cells, std::vector<char>& is_wall) {
  std::fill(is_wall.begin(), is_wall.end(), char{0});
  for (int row = top; row > std::max(-1, top - cells); --row) {
    for (int column = 0; column < map.width; ++column) {
      if (map.at(column, row) == CellState::kOccupied) is_wall[static_cast<std::size_t>(column / cells)] = 1;
    }
  }
}

void append_runs(const std::vector<char>& is_wall, int y, std::string& out) {
  for (auto begin = is_wall.begin();;) {
    begin = std::find(begin, is_wall.end(), 1);
    if (begin == is_wall.end()) return;
    const auto end = std::find(begin, is_wall.end(), 0);
    out += 'M' + std::to_string(begin - is_wall.begin()) + ' ' + std::to_string(y) + ".5h" +
           std::to_string(end - begin);
    begin = end;
  }
}

struct Span {
  int begin = 0, end = 0;
};

/// Where the counts lie, without the outermost of either side.
Span middle_of(const std::vector<std::size_t>& counts) {
  const auto total = std::accumulate(counts.begin(), counts.end(), std::size_t{0});
  const auto rim = static_cast<std::size_t>(kRimShare * static_cast<double>(total));
  const auto skipped = [&](auto it, auto end) {
    int n = 0;
    for (std::size_t sum = 0; it != end && (sum += *it) <= rim; ++it) ++n;
    return n;
  };
  return {skipped(counts.begin(), counts.end()),
          static_cast<int>(counts.size()) - skipped(counts.rbegin(), counts.rend())};
}

}  // namespace

Eigen::AlignedBox2d walls_box_map(const TrinaryMap& map) {
  std::vector<std::size_t> in_column(static_cast<std::size_t>(map.width));
  std::vector<std::size_t> in_row(static_cast<std::size_t>(map.height));
  for (int row = 0; row < map.height; ++row) {
    for (int column = 0; column < map.width; ++column) {
      if (map.at(column, row) != CellState::kOccupied) continue;
      ++in_column[static_cast<std::size_t>(column)];
      ++in_row[static_cast<std::size_t>(row)];
    }
  }
  const Span x = middle_of(in_column), y = middle_of(in_row);
  if (x.begin >= x.end) return {};
  const Eigen::Vector2d origin(map.origin.x, map.origin.y);
  return {map.cell_size_m * (origin + Eigen::Vector2d(x.begin, y.begin)),
          map.cell_size_m * (origin + Eigen::Vector2d(x.end, y.end))};
}

std::string wall_runs(const TrinaryMap& map, int cells) {
  std::string out;
  std::vector<char> is_wall(static_cast<std::size_t>((map.width + cells - 1) / cells));
  for (int y = 0; y * cells < map.height; ++y) {
    mark_walls(map, map.height - 1 - y * cells, cells, is_wall);
    append_runs(is_wall, y, out);
  }
  return out;
}

}  // namespace dynslam
