// SPDX-License-Identifier: MIT
#include "io/map_picture.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <png.h>

#include "io/drawn_map.h"
#include "io/png_writer.h"
#include "io/stroke_font.h"

namespace dynslam {
namespace {

constexpr Rgb kWall{30, 38, 51}, kFloor{252, 252, 250}, kUnknown{211, 220, 231};
constexpr Rgb kStart{34, 160, 84}, kEnd{222, 45, 52}, kInk{62, 74, 92};

struct Picture {
  int width = 0, height = 0;
  std::vector<Rgb> pixels;

  Rgb at(int x, int y) const { return pixels[static_cast<std::size_t>(y * width + x)]; }
  std::size_t count(Rgb colour) const {
    return static_cast<std::size_t>(std::count(pixels.begin(), pixels.end(), colour));
  }
  /// Mean position of the pixels of a colour.
  Vector2 middle_of(Rgb colour) const {
    Vector2 sum(0.0, 0.0);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        if (at(x, y) == colour) sum += Vector2(x + 0.5, y + 0.5);
      }
    }
    return sum / static_cast<double>(count(colour));
  }
};

Picture decode(const std::string& png) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  EXPECT_NE(png_image_begin_read_from_memory(&image, png.data(), png.size()), 0) << image.message;
  EXPECT_EQ(image.format, static_cast<png_uint_32>(PNG_FORMAT_RGB));
  Picture picture{static_cast<int>(image.width), static_cast<int>(image.height), {}};
  picture.pixels.resize(std::size_t{image.width} * image.height);
  EXPECT_NE(png_image_finish_read(&image, nullptr, picture.pixels.data(), 0, nullptr), 0) << image.message;
  return picture;
}

TrinaryMap filled_map(int width, int height, CellState state) {
  TrinaryMap map;
  map.width = width;
  map.height = height;
  map.cells.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), state);
  return map;
}

void set(TrinaryMap& map, int column, int row, CellState state) {
  map.cells[static_cast<std::size_t>(row * map.width + column)] = state;
}

TEST(MapPicture, EnlargesASmallMapByWholePixels) {
  const Picture p = decode(to_png(drawn_map({"##",  //
                                             "#."})));
  EXPECT_GE(std::max(p.width, p.height), 800);
  EXPECT_LE(std::max(p.width, p.height), 1000);
  EXPECT_EQ(p.count(kWall), 3U * 380 * 380);
  EXPECT_EQ(p.count(kFloor), 380U * 380);
  EXPECT_LT(p.middle_of(kWall).x(), p.middle_of(kFloor).x()) << "x grows to the right";
  EXPECT_LT(p.middle_of(kWall).y(), p.middle_of(kFloor).y()) << "y grows upwards, rows of pixels down";
}

TEST(MapPicture, LeavesAMarginAllAround) {
  const Picture p = decode(to_png(drawn_map({"#"})));
  for (int x = 0; x < p.width; ++x) EXPECT_TRUE(p.at(x, 0) == kUnknown && p.at(x, p.height - 1) == kUnknown);
  for (int y = 0; y < p.height; ++y) EXPECT_TRUE(p.at(0, y) == kUnknown && p.at(p.width - 1, y) == kUnknown);
}

TEST(MapPicture, CropsToWhatIsKnown) {
  const TrinaryMap bare = drawn_map({"#.", ".#"}, {3, 2});
  const TrinaryMap wide = drawn_map({"     ", "  #. ", "  .# ", "     ", "     "}, {1, 0});
  EXPECT_EQ(to_png(bare, {{{0.08, 0.06}}}), to_png(wide, {{{0.08, 0.06}}}));
}

TEST(MapPicture, ShrinksALargeMapAndKeepsEveryWall) {
  TrinaryMap map = filled_map(5000, 3001, CellState::kFree);
  for (int row = 0; row < map.height; ++row) set(map, 2500, row, CellState::kOccupied);
  set(map, 100, 1500, CellState::kOccupied);
  const Picture p = decode(to_png(map));
  EXPECT_LE(std::max(p.width, p.height), 2400);
  EXPECT_GE(std::max(p.width, p.height), 800);
  const std::size_t map_rows = 3001 / 3 + 1;
  EXPECT_GE(p.count(kWall), 2 * map_rows + 4) << "two pixels wide, so that it lasts when shown smaller";
  EXPECT_LE(p.count(kWall), 2 * map_rows + 10);
}

TEST(MapPicture, DrawsWallsAtTheEdgeOfALargeMapAsWideAsOthers) {
  TrinaryMap map = filled_map(1000, 1000, CellState::kFree);
  for (int i = 0; i < 1000; ++i) {
    set(map, 0, i, CellState::kOccupied);
    set(map, 999, i, CellState::kOccupied);
    set(map, i, 0, CellState::kOccupied);
    set(map, i, 999, CellState::kOccupied);
  }
  EXPECT_EQ(decode(to_png(map)).count(kWall), 1001U * 1001 - 997 * 997);
}

TEST(MapPicture, GradesHalfKnownPixels) {
  TrinaryMap map = filled_map(4400, 4, CellState::kFree);
  for (int column = 1000; column < 1200; column += 2) {
    for (int row = 0; row < 4; ++row) set(map, column, row, CellState::kUnknown);
  }
  EXPECT_GT(decode(to_png(map)).count(mix(kUnknown, kFloor, 0.5F)), 50U);
}

TEST(MapPicture, ShowsAnEmptyOrUnknownMapAsUnknown) {
  for (const TrinaryMap& map : {drawn_map({}), drawn_map({"  ", "  "})}) {
    const Picture p = decode(to_png(map));
    EXPECT_GE(std::max(p.width, p.height), 800);
    EXPECT_EQ(p.count(kFloor) + p.count(kWall), 0U);
    EXPECT_GT(p.count(kUnknown), p.pixels.size() * 9 / 10);
  }
}

TEST(MapPicture, MarksStartAndEndWhereTheyAre) {
  const TrinaryMap map = filled_map(100, 50, CellState::kFree);  // 2 m by 1 m, 8 pixels a cell
  const Picture p = decode(to_png(map, {{{0.5, 0.25}, {1.5, 0.75}}}));
  const Vector2 step = p.middle_of(kEnd) - p.middle_of(kStart);
  EXPECT_NEAR(step.x(), 400.0, 1.0);
  EXPECT_NEAR(step.y(), -200.0, 1.0);
}

TEST(MapPicture, PutsThePathIntoTheFrameOfAShiftedMap) {
  TrinaryMap map = filled_map(100, 50, CellState::kFree);
  const std::string there = to_png(map, {{{0.5, 0.25}, {1.5, 0.75}}});
  map.origin = {-1000, 500};
  EXPECT_EQ(to_png(map, {{{-19.5, 10.25}, {-18.5, 10.75}}}), there);
}

TEST(MapPicture, ShowsStartAndEndAtTheSamePlace) {
  const Picture p =
      decode(to_png(filled_map(100, 50, CellState::kFree), {{{1.0, 0.5}, {1.5, 0.5}, {1.0, 0.5}}}));
  EXPECT_GT(p.count(kStart), 20U);
  EXPECT_GT(p.count(kEnd), 20U);
  EXPECT_LT((p.middle_of(kStart) - p.middle_of(kEnd)).norm(), 1.0);
}

TEST(MapPicture, GradesThePathFromStartToEnd) {
  const Picture p =
      decode(to_png(filled_map(100, 50, CellState::kFree), {{{0.2, 0.5}, {1.0, 0.5}, {1.8, 0.5}}}));
  const int y = static_cast<int>(p.middle_of(kEnd).y());
  const auto near_start = p.at(static_cast<int>(p.middle_of(kStart).x()) + 20, y);
  const auto near_end = p.at(static_cast<int>(p.middle_of(kEnd).x()) - 20, y);
  EXPECT_GT(near_start.b, near_start.r);
  EXPECT_GT(near_end.r, near_end.b);
}

TEST(MapPicture, EndsThePathInSmoothEdges) {
  const Picture p = decode(to_png(filled_map(100, 50, CellState::kFree), {{{0.2, 0.2}, {1.8, 0.7}}}));
  std::size_t between = 0;
  for (const Rgb c : p.pixels) between += c != kFloor && c != kUnknown && c.g > 130 && c.g < 245;
  EXPECT_GT(between, 500U);
}

TEST(MapPicture, BearsAnyPath) {
  const double inf = std::numeric_limits<double>::infinity();
  const TrinaryMap map = filled_map(20, 20, CellState::kFree);
  EXPECT_EQ(to_png(map, {{{inf, 0.0}, {0.0, std::nan("")}}}), to_png(map));
  EXPECT_EQ(decode(to_png(map, {{{1e9, -1e9}, {1e300, 1e300}}})).pixels, decode(to_png(map)).pixels);
  EXPECT_GT(decode(to_png(map, {{{-1e6, 0.2}, {1e6, 0.2}}})).count(kFloor), 1000U);
}

TEST(MapPicture, HasAScaleBarOfARoundLength) {
  const Picture p = decode(to_png(filled_map(100, 100, CellState::kFree)));
  int longest = 0;
  for (int y = 0; y < p.height; ++y) {
    int run = 0;
    for (int x = 0; x < p.width; ++x) longest = std::max(longest, run = p.at(x, y) == kInk ? run + 1 : 0);
  }
  EXPECT_NEAR(longest, 200, 2) << "0.5 m at 8 pixels a cell of 2 cm";
}

TEST(MapPicture, LeavesRoomForTheScaleBarOfANarrowMap) {
  const Picture p = decode(to_png(filled_map(3, 2000, CellState::kFree)));
  EXPECT_GT(p.width, 400);
}

TEST(MapPicture, LabelsKilometres) {
  TrinaryMap map = filled_map(900, 900, CellState::kFree);
  map.cell_size_m = 10.0;
  EXPECT_GT(decode(to_png(map)).count(kInk), 100U);
}

TEST(MapPicture, GivesTheSameBytesAgain) {
  const TrinaryMap map = drawn_map({"#.#", ".#."});
  EXPECT_EQ(to_png(map, {{{0.0, 0.0}, {0.03, 0.03}}}), to_png(map, {{{0.0, 0.0}, {0.03, 0.03}}}));
}

TEST(PngWriter, RefusesASizeThatPngDoesNotHave) {
  EXPECT_THROW(PngWriter(0, 1), std::runtime_error);
  EXPECT_THROW(PngWriter(1, -1), std::runtime_error);
}

TEST(PngWriter, RefusesToEndEarly) {
  PngWriter png(1, 1);
  EXPECT_THROW(png.finish(), std::runtime_error);
}

TEST(PictureBand, DrawsTheSameInBandsAsAtOnce) {
  const Stroke stroke{{{3.0F, 2.0F, kStart}, {28.0F, 21.0F, kEnd}, {5.0F, 29.0F, kWall}}, 3.5F, 1.5F};
  PictureBand whole(32, 32), band(32, 5);
  whole.move_to(0, 32);
  whole.draw(stroke);
  for (int y = 0; y < 32; y += 5) {
    band.move_to(y, std::min(5, 32 - y));
    for (int row = y; row < y + band.rows(); ++row)
      std::fill(band.row(row).begin(), band.row(row).end(), Rgb{});
    band.draw(stroke);
    for (int row = y; row < y + band.rows(); ++row) {
      EXPECT_TRUE(std::equal(band.row(row).begin(), band.row(row).end(), whole.row(row).begin())) << row;
    }
  }
}

TEST(PictureBand, DrawsADiscOfItsArea) {
  PictureBand band(40, 40);
  band.move_to(0, 40);
  band.draw({{{20.0F, 20.0F, {255, 255, 255}}}, 20.0F, 0.0F});
  double area = 0.0;
  for (int y = 0; y < 40; ++y) {
    for (const Rgb c : band.row(y)) area += c.g / 255.0;
  }
  EXPECT_NEAR(area, 314.0, 3.0);
}

TEST(PictureBand, DrawsNothingForNoPoints) {
  PictureBand band(2, 2);
  band.move_to(0, 2);
  band.draw({});
  EXPECT_EQ(band.row(1)[1], Rgb{});
}

TEST(StrokeFont, KnowsWhatAScaleBarSays) {
  for (const char letter : std::string("0123456789.mk")) {
    EXPECT_FALSE(text_strokes({&letter, 1}, 0.0F, 0.0F, 12.0F, kWall).empty()) << letter;
  }
  EXPECT_TRUE(text_strokes(" ?", 0.0F, 0.0F, 12.0F, kWall).empty());
}

TEST(StrokeFont, StaysInItsBox) {
  const std::string text = "0.5 km";
  for (const Stroke& stroke : text_strokes(text, 10.0F, 20.0F, 12.0F, kWall)) {
    for (const StrokePoint& p : stroke.points) {
      EXPECT_GE(p.x, 10.0F);
      EXPECT_LE(p.x, 10.001F + text_width(text, 12.0F));
      EXPECT_GE(p.y, 20.0F);
      EXPECT_LE(p.y, 32.0F);
    }
  }
  EXPECT_EQ(text_width("", 12.0F), 0.0F);
}

}  // namespace
}  // namespace dynslam
