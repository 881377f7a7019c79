// SPDX-License-Identifier: MIT
#include "io/map_picture.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>
#include <utility>

#include "io/picture_band.h"
#include "io/picture_layout.h"
#include "io/png_writer.h"
#include "io/scale_length.h"
#include "io/stroke_font.h"

namespace dynslam {
namespace {

constexpr Rgb kWall{30, 38, 51};
constexpr Rgb kFloor{252, 252, 250};
constexpr Rgb kUnknown{211, 220, 231};
constexpr Rgb kInk{62, 74, 92};
constexpr Rgb kStart{34, 160, 84};
constexpr Rgb kEnd{222, 45, 52};
constexpr Rgb kPathColours[] = {{46, 91, 219}, {140, 70, 214}, {226, 62, 140}, {245, 134, 42}};

constexpr int kBandRows = 32;

CellState state_at(const TrinaryMap& map, int column, int row) {
  const bool is_inside = column >= 0 && column < map.width && row >= 0 && row < map.height;
  return is_inside ? map.at(column, row) : CellState::kUnknown;
}

/// What the cells of a pixel look like: `count` columns and rows from (left, top) to the right and down.
Rgb ground_colour(const TrinaryMap& map, int left, int top, int count) {
  int free = 0;
  for (int row = top; row > top - count; --row) {
    for (int column = left; column < left + count; ++column)
      free += state_at(map, column, row) == CellState::kFree;
  }
  return mix(kUnknown, kFloor, static_cast<float>(free) / static_cast<float>(count * count));
}

bool has_wall(const TrinaryMap& map, int left, int top, int count) {
  for (int row = top; row > top - count; --row) {
    for (int column = left; column < left + count; ++column) {
      if (state_at(map, column, row) == CellState::kOccupied) return true;
    }
  }
  return false;
}

/// One row of pixels; `row` counts from the top of the map.
void draw_map_row(const TrinaryMap& map, const PictureLayout& l, int row, std::span<Rgb> pixels) {
  const int top = l.bottom + l.rows - 1 - row * l.shrink / l.enlarge;
  // A line of single pixels is lost once the picture is shown smaller: where cells are that small, a wall
  // takes the pixel before it too.
  const int wall_reach = l.enlarge == 1 ? 2 * l.shrink : 1;
  for (int x = 0; x < l.map_width; ++x) {
    const int left = l.left + x * l.shrink / l.enlarge;
    pixels[static_cast<std::size_t>(l.offset_x + x)] =
        has_wall(map, left, top, wall_reach) ? kWall : ground_colour(map, left, top, l.shrink);
  }
}

void draw_map(const TrinaryMap& map, const PictureLayout& l, PictureBand& band) {
  for (int y = band.first_row(); y < band.first_row() + band.rows(); ++y) {
    const std::span<Rgb> pixels = band.row(y);
    std::fill(pixels.begin(), pixels.end(), kUnknown);
    const int row = y - l.margin;
    if (row >= 0 && row < l.map_height) draw_map_row(map, l, row, pixels);
  }
}

Rgb path_colour(double share) {
  constexpr int kSteps = static_cast<int>(std::size(kPathColours)) - 1;
  const double at = share * kSteps;
  const int step = std::clamp(static_cast<int>(at), 0, kSteps - 1);
  return mix(kPathColours[step], kPathColours[step + 1], static_cast<float>(at - step));
}

StrokePoint to_picture(const TrinaryMap& map, const PictureLayout& l, const Vector2& point_map) {
  const Vector2 cell = point_map / map.cell_size_m - Vector2(map.origin.x, map.origin.y);
  const double x = l.offset_x + (cell.x() - l.left) * l.pixels_per_cell();
  const double y = l.margin + (l.bottom + l.rows - cell.y()) * l.pixels_per_cell();
  const auto bounded = [](double v) {
    return static_cast<float>(std::clamp(v, -1e7, 1e7));
  };  // floats may square it
  return {bounded(x), bounded(y), kInk};
}

float distance_px(const StrokePoint& a, const StrokePoint& b) { return std::hypot(b.x - a.x, b.y - a.y); }

/// The path without the points that would fall on the same pixel: a robot that stands still adds one each
/// scan.
std::vector<StrokePoint> thin_path(const TrinaryMap& map, const PictureLayout& l,
                                   const std::vector<Vector2>& path_map) {
  std::vector<StrokePoint> points;
  for (const Vector2& p : path_map) {
    if (!p.allFinite()) continue;
    const StrokePoint next = to_picture(map, l, p);
    const bool is_new =
        points.empty() || std::hypot(next.x - points.back().x, next.y - points.back().y) >= 1.0F;
    if (is_new) points.push_back(next);
  }
  return points;
}

/// Colours by the way travelled, not by time: standing still should not use them up.
void colour_path(std::vector<StrokePoint>& points) {
  double length = 0.0;
  const auto step = [&](std::size_t i) { return distance_px(points[i - 1], points[i]); };
  for (std::size_t i = 1; i < points.size(); ++i) length += step(i);
  double travelled = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i > 0) travelled += step(i);
    points[i].colour = path_colour(length > 0.0 ? travelled / length : 0.0);
  }
}

void append_path(const TrinaryMap& map, const PictureLayout& l, const MapPictureLayers& layers,
                 std::vector<Stroke>& out) {
  std::vector<StrokePoint> points = thin_path(map, l, layers.path_map);
  if (points.empty()) return;
  colour_path(points);
  const auto disc = [&](const StrokePoint& at, Rgb colour, float share, float halo) {
    out.push_back({{{at.x, at.y, colour}}, share * l.line_px, halo * l.line_px});
  };
  const StrokePoint start = points.front(), end = points.back();
  out.push_back({std::move(points), l.line_px, 0.35F * l.line_px});
  disc(start, kStart, 7.0F, 0.4F);  // wide enough to be seen around an end at the same place
  disc(start, kFloor, 4.6F, 0.0F);
  disc(end, kEnd, 3.6F, 0.4F);
}

void append_scale_bar(const TrinaryMap& map, const PictureLayout& l, std::vector<Stroke>& out) {
  const double pixels_per_m = l.pixels_per_cell() / map.cell_size_m;
  const double length_m = round_length(std::max(l.map_width, l.width / 2) / 4.0 / pixels_per_m);
  // Whole pixels, for a crisp line: an even width about the border of two rows.
  const float width_px = l.line_px < 5.0F ? 2.0F : 4.0F;
  const auto x = static_cast<float>(std::min(l.offset_x, l.margin));
  const auto y = static_cast<float>(l.height - l.margin);
  const float end = x + static_cast<float>(std::round(length_m * pixels_per_m));
  const float tick = std::round(l.text_px * 0.35F);
  out.push_back({{{x, y - tick, kInk}, {x, y, kInk}, {end, y, kInk}, {end, y - tick, kInk}}, width_px, 0.0F});
  const float label_x = end + 0.7F * l.text_px, label_y = y - 0.9F * l.text_px;
  for (Stroke& s : text_strokes(length_label(length_m), label_x, label_y, l.text_px, kInk)) {
    out.push_back(std::move(s));
  }
}

}  // namespace

std::string to_png(const TrinaryMap& map, const MapPictureLayers& layers) {
  const PictureLayout layout = lay_out(map);
  std::vector<Stroke> strokes;
  append_path(map, layout, layers, strokes);
  append_scale_bar(map, layout, strokes);

  PngWriter png(layout.width, layout.height);
  PictureBand band(layout.width, kBandRows);
  for (int y = 0; y < layout.height; y += kBandRows) {
    band.move_to(y, std::min(kBandRows, layout.height - y));
    draw_map(map, layout, band);
    for (const Stroke& stroke : strokes) band.draw(stroke);
    for (int row = y; row < y + band.rows(); ++row) png.write_row(band.row(row));
  }
  return png.finish();
}

}  // namespace dynslam
