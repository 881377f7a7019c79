// SPDX-License-Identifier: MIT
#include "io/map_picture.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <span>
#include <utility>
#include <vector>

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
constexpr Rgb kRoute{16, 138, 92};
constexpr Rgb kPlace{240, 140, 20};
constexpr Rgb kPathColours[] = {{46, 91, 219}, {140, 70, 214}, {226, 62, 140}, {245, 134, 42}};

constexpr int kBandRows = 32;

/// Draws rows of pixels from the rows of cells that lie under them.
class MapRows {
 public:
  MapRows(const TrinaryMap& map, const PictureLayout& layout)
      : map_(map),
        l_(layout),
        // A line of single pixels is lost once the picture is shown smaller: where cells are that small, a
        // wall takes the pixel before it too.
        wall_reach_(layout.enlarge == 1 ? 2 * layout.shrink : 1),
        ground_(static_cast<std::size_t>(layout.shrink * layout.shrink) + 1),
        free_(static_cast<std::size_t>(layout.columns + wall_reach_)),
        walls_(free_.size()) {
    const auto all = static_cast<float>(ground_.size() - 1);
    for (std::size_t n = 0; n < ground_.size(); ++n)
      ground_[n] = mix(kUnknown, kFloor, static_cast<float>(n) / all);
  }

  /// `row` counts from the top of the map.
  void draw(int row, std::span<Rgb> pixels) {
    const int top = l_.bottom + l_.rows - 1 - row * l_.shrink / l_.enlarge;
    if (top != top_) count(top);
    for (int x = 0; x < l_.map_width; ++x) {
      const int column = x * l_.shrink / l_.enlarge;
      pixels[static_cast<std::size_t>(l_.offset_x + x)] =
          sum(walls_, column, wall_reach_) > 0 ? kWall : ground_[sum(free_, column, l_.shrink)];
    }
  }

 private:
  /// How many cells of each column, from row `top` down, are free and how many are walls.
  void count(int top) {
    top_ = top;
    std::fill(free_.begin(), free_.end(), 0U);
    std::fill(walls_.begin(), walls_.end(), 0U);
    const int left = std::max(0, l_.left),
              right = std::min(map_.width, l_.left + static_cast<int>(free_.size()));
    for (int below = 0; below < wall_reach_; ++below) {
      const int row = top - below;
      if (row < 0 || row >= map_.height) continue;
      const std::uint32_t as_ground = below < l_.shrink ? 1 : 0;
      for (int column = left; column < right; ++column) {
        const CellState state = map_.at(column, row);
        const auto i = static_cast<std::size_t>(column - l_.left);
        free_[i] += state == CellState::kFree ? as_ground : 0;
        walls_[i] += state == CellState::kOccupied ? 1U : 0U;
      }
    }
  }

  static std::size_t sum(const std::vector<std::uint32_t>& counts, int first, int n) {
    std::size_t total = 0;
    for (int i = first; i < first + n; ++i) total += counts[static_cast<std::size_t>(i)];
    return total;
  }

  const TrinaryMap& map_;
  const PictureLayout& l_;
  int wall_reach_;
  std::vector<Rgb> ground_;  ///< by how many cells under a pixel are free
  int top_ = std::numeric_limits<int>::min();
  std::vector<std::uint32_t> free_, walls_;  ///< of the columns from the layout's left on
};

void draw_map(MapRows& map, const PictureLayout& l, PictureBand& band) {
  for (int y = band.first_row(); y < band.first_row() + band.rows(); ++y) {
    const std::span<Rgb> pixels = band.row(y);
    std::fill(pixels.begin(), pixels.end(), kUnknown);
    const int row = y - l.margin;
    if (row >= 0 && row < l.map_height) map.draw(row, pixels);
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

/// `share` of a line's width across.
Stroke disc(const PictureLayout& l, const StrokePoint& at, Rgb colour, float share, float halo) {
  return {{{at.x, at.y, colour}}, share * l.line_px, halo * l.line_px};
}

void append_route(const TrinaryMap& map, const PictureLayout& l, const MapPictureLayers& layers,
                  std::vector<Stroke>& out) {
  for (const StrokePoint& p : thin_path(map, l, layers.places_map))
    out.push_back(disc(l, p, kPlace, 3.0F, 0.5F));
  std::vector<StrokePoint> points = thin_path(map, l, layers.route_map);
  if (points.empty()) return;
  for (StrokePoint& p : points) p.colour = kRoute;
  out.push_back({points, l.line_px, 0.35F * l.line_px});
  for (const StrokePoint& p : points) out.push_back(disc(l, p, kRoute, 2.4F, 0.3F));
  out.push_back(disc(l, points.back(), kRoute, 5.0F, 0.4F));
  out.push_back(disc(l, points.back(), kFloor, 2.4F, 0.0F));
}

void append_path(const TrinaryMap& map, const PictureLayout& l, const MapPictureLayers& layers,
                 std::vector<Stroke>& out) {
  std::vector<StrokePoint> points = thin_path(map, l, layers.path_map);
  if (points.empty()) return;
  colour_path(points);
  const StrokePoint start = points.front(), end = points.back();
  out.push_back({std::move(points), l.line_px, 0.35F * l.line_px});
  out.push_back(
      disc(l, start, kStart, 7.0F, 0.4F));  // wide enough to be seen around an end at the same place
  out.push_back(disc(l, start, kFloor, 4.6F, 0.0F));
  out.push_back(disc(l, end, kEnd, 3.6F, 0.4F));
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
  append_route(map, layout, layers, strokes);
  append_path(map, layout, layers, strokes);
  append_scale_bar(map, layout, strokes);

  PngWriter png(layout.width, layout.height);
  PictureBand band(layout.width, kBandRows);
  MapRows rows(map, layout);
  for (int y = 0; y < layout.height; y += kBandRows) {
    band.move_to(y, std::min(kBandRows, layout.height - y));
    draw_map(rows, layout, band);
    for (const Stroke& stroke : strokes) band.draw(stroke);
    for (int row = y; row < y + band.rows(); ++row) png.write_row(band.row(row));
  }
  return png.finish();
}

}  // namespace dynslam
