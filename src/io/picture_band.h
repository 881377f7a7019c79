// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace dynslam {

struct Rgb {
  std::uint8_t r = 0;
  std::uint8_t g = 0;
  std::uint8_t b = 0;
  bool operator==(const Rgb&) const = default;
};
static_assert(sizeof(Rgb) == 3, "rows of Rgb go to the PNG as they are");

/// The colour a share `t` (0 = a, 1 = b) of the way from a to b.
Rgb mix(Rgb a, Rgb b, float t);

/// A point of a line, in pixels of the whole picture: x to the right, y down, (0, 0) the picture's corner.
struct StrokePoint {
  float x = 0.0F;
  float y = 0.0F;
  Rgb colour;
};

/// A line with round ends through its points; a single point is a disc.
struct Stroke {
  std::vector<StrokePoint> points;
  float width_px = 1.0F;
  float halo_px = 0.0F;  ///< pale seam around it that sets it off from what lies below
};

/// Some rows of a picture. Drawing a large picture band by band keeps it out of memory: move the band down,
/// fill its rows, draw every stroke (what lies outside is left out), hand the rows on.
class PictureBand {
 public:
  /// Both at least 1.
  PictureBand(int width, int max_rows);

  /// The band now is `rows` (1 to max_rows) rows from `first_row` on; its pixels are what they were.
  void move_to(int first_row, int rows);

  int width() const { return width_; }
  int first_row() const { return first_row_; }
  int rows() const { return rows_; }

  /// The pixels of a row of the picture, which must be within the band.
  std::span<Rgb> row(int y) {
    return std::span(pixels_).subspan(offset(y), static_cast<std::size_t>(width_));
  }

  /// Anti-aliased, and as one shape: where it overlaps itself, its edges do not add up.
  void draw(const Stroke& stroke);

 private:
  /// Of a shape, how much of a pixel it covers (0 to 255) and with what.
  struct Cover {
    std::uint8_t share = 0;
    Rgb colour;
  };

  std::size_t offset(int y) const {
    return static_cast<std::size_t>(y - first_row_) * static_cast<std::size_t>(width_);
  }
  void draw_shape(const Stroke& stroke, float radius_px, const Rgb* single_colour);
  bool cover_segment(const StrokePoint& a, const StrokePoint& b, float radius_px);
  void blend_cover(const Rgb* single_colour);

  int width_;
  int first_row_ = 0;
  int rows_ = 0;
  std::vector<Rgb> pixels_;
  std::vector<Cover> cover_;  // all zero between two shapes
};

}  // namespace dynslam
