// SPDX-License-Identifier: MIT
#include "plan/outline_cells.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace dynslam {
namespace {

/// Corners farther out are moved in to here, so that nothing overflows.
constexpr double kFarthest_cells = 1e9;

/// In cells, such that cell centres have whole coordinates.
std::vector<Vector2> corners_in_cells(std::span<const Vector2> outline_m, double cell_size_m) {
  std::vector<Vector2> corners;
  for (const Vector2& p : outline_m) {
    if (!p.allFinite()) return {};
    corners.emplace_back(
        (p / cell_size_m - Vector2(0.5, 0.5)).cwiseMin(kFarthest_cells).cwiseMax(-kFarthest_cells));
  }
  return corners;
}

/// Where the outline crosses the line of a row, from left to right.
void find_crossings(const std::vector<Vector2>& corners, double y, std::vector<double>& crossings) {
  crossings.clear();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector2 &a = corners[i], &b = corners[(i + 1) % corners.size()];
    if ((a.y() <= y) == (b.y() <= y)) continue;
    crossings.push_back(a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x()));
  }
  std::sort(crossings.begin(), crossings.end());
}

/// The bits `first` up to `end` of a row.
void set_bits(std::uint64_t* row, int first, int end) {
  for (int i = first; i < end;) {
    const int bit = i & kChunkMask, count = std::min(kChunkSide - bit, end - i);
    const std::uint64_t ones = count == kChunkSide ? ~std::uint64_t{0} : (std::uint64_t{1} << count) - 1;
    row[i >> kChunkBits] |= ones << bit;
    i += count;
  }
}

}  // namespace

void add_inside(std::span<const Vector2> outline_m, double cell_size_m, CellBitmap& cells) {
  const std::vector<Vector2> corners = corners_in_cells(outline_m, cell_size_m);
  if (corners.size() < 3) return;
  const CellIndex first = cells.first();
  const double width = cells.words_per_row() * kChunkSide;
  const auto [lowest, highest] = std::minmax_element(
      corners.begin(), corners.end(), [](const Vector2& a, const Vector2& b) { return a.y() < b.y(); });
  const auto row_at = [&](double y) {
    return static_cast<int>(std::clamp(std::ceil(y) - first.y, 0.0, double(cells.rows())));
  };
  const auto column_at = [&](double x) {
    return static_cast<int>(std::clamp(std::ceil(x) - first.x, 0.0, width));
  };
  std::vector<double> crossings;
  const int end = row_at(highest->y() + 1);
  for (int r = row_at(lowest->y()); r < end; ++r) {
    find_crossings(corners, double(first.y) + r, crossings);
    for (std::size_t i = 0; i + 1 < crossings.size(); i += 2)
      set_bits(cells.row(r), column_at(crossings[i]), column_at(crossings[i + 1]));
  }
}

}  // namespace dynslam
