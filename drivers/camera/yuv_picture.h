// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace dynslam {

/// Rows of bytes, `stride` apart, in somebody else's memory.
struct Plane {
  const std::uint8_t* bytes = nullptr;
  std::size_t stride = 0;
};

/// A picture of planes Y, U and V, the last two with half the columns and rows (YUV 4:2:0).
/// Width and height are even.
struct YuvView {
  int width = 0, height = 0;
  std::array<Plane, 3> planes;

  /// Columns and rows of a plane.
  int width_of(std::size_t plane) const { return plane == 0 ? width : width / 2; }
  int height_of(std::size_t plane) const { return plane == 0 ? height : height / 2; }
};

/// A copy in memory of its own, which keeps its size from picture to picture.
class YuvPicture {
 public:
  /// Reads each byte once, row by row, as a camera's memory may be slow to read.
  void copy(const YuvView& from, bool upside_down);
  /// Good until the next copy().
  const YuvView& view() const { return view_; }

 private:
  std::vector<std::uint8_t> bytes_;
  YuvView view_;
};

}  // namespace dynslam
