// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "io/graph_picture.h"

namespace dynslam {

/// Classes of closures by how far off they stay, from calm to loud.
inline constexpr int kClosureBands = 4;

/// The class of a closure: 0 below one standard deviation, 3 from three on, or when it is not a number.
int closure_band(double residual);

/// A line of the legend.
struct LegendRow {
  std::string sample;  ///< SVG of what it speaks of, from (0, 0) 34 pixels to the right; may be empty
  std::optional<std::size_t> count;
  std::string label;       ///< fit for XML
  bool is_detail = false;  ///< its count is part of one above
};

/// What there is, from the local maps down to what was left out (`left_out` things that have no place). What
/// many graphs have none of is named only where there is some.
std::vector<LegendRow> legend_rows(const GraphPicture& graph, std::size_t left_out);

}  // namespace dynslam
