// SPDX-License-Identifier: MIT
#include "slam/global_map.h"

#include <limits>

#include <gtest/gtest.h>

#include "grid/drawn_map.h"

namespace dynslam {
namespace {

constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();

/// A finished map as it is seen: '#' surface, '.' free; the lower left cell is `low`, its origin is the drawn
/// frame's.
std::shared_ptr<const FinishedMap> drawn(std::uint32_t id, const std::vector<std::string>& rows,
                                         CellIndex low = {}) {
  auto map = std::make_shared<FinishedMap>();
  map->id = id;
  map->ended = time_at_s(id);
  CellBitmap free, occupied;
  free.reset({{-2, -2}, {2, 2}});
  occupied.reset({{-2, -2}, {2, 2}});
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (std::size_t c = 0; c < rows[r].size(); ++c) {
      const CellIndex cell{low.x + static_cast<int>(c), low.y + static_cast<int>(rows.size() - 1 - r)};
      if (rows[r][c] == '.') free.set(cell);
      if (rows[r][c] == '#') occupied.set(cell);
    }
  }
  map->free = TiledBitmap(free);
  map->occupied = TiledBitmap(occupied);
  return map;
}

/// A global map and the grid that shows it, as a robot has them.
class ShownMap {
 public:
  GlobalMap map{0.02};

  std::vector<std::string> picture(int width, int height, CellIndex low = {}) {
    EXPECT_EQ(map.redraw(kAll), 0U);
    for (const DrawnChunk& c : map.publish()) grid_.show(c.index, c.free, c.occupied);
    return drawing_of(grid_, low, width, height);
  }

 private:
  ChunkedGrid grid_{0.02, 4096};
};

using Rows = std::vector<std::string>;

TEST(GlobalMap, ShowsAMapWhereItIs) {
  GlobalMap map(0.02, 4096);
  map.place(drawn(0, {"#####", "#...#", "#####"}), {});
  EXPECT_EQ(picture(map, 5, 3), (Rows{"#####", "#...#", "#####"}));
  map.move({{0, Pose2{0.2, -0.1, 0}}});
  EXPECT_EQ(picture(map, 5, 3, {10, -5}), (Rows{"#####", "#...#", "#####"}));
  EXPECT_EQ(picture(map, 5, 3), (Rows{"     ", "     ", "     "})) << "and no longer where it was";
}

TEST(GlobalMap, TurnsAMapWithItsOrigin) {
  GlobalMap map(0.02, 4096);
  map.place(drawn(0, {"....", "...."}), {0, 0, radians(90)});
  EXPECT_EQ(picture(map, 2, 4, {-2, 0}), (Rows{"..", "..", "..", ".."}));
}

TEST(GlobalMap, TheNewerMapHasTheWord) {
  GlobalMap map(0.02, 4096);
  map.place(drawn(0, {"......", "..##..", "......"}), {});
  map.place(drawn(1, {"......", "......", ".#...."}), {});
  EXPECT_EQ(picture(map, 6, 3), (Rows{"......", "......", ".#...."})) << "what was taken away is gone";
}

TEST(GlobalMap, ANewerMapThatSawLessTakesNothingAway) {
  GlobalMap map(0.02, 4096);
  map.place(drawn(0, {"########", "#......#", "#......#", "########"}), {});
  map.place(drawn(1, {"..."}, {1, 0}), {});
  EXPECT_EQ(picture(map, 8, 4), (Rows{"########", "#......#", "#......#", "#...####"}));
}

TEST(GlobalMap, AWallSeenAgainACellOffIsOneWall) {
  GlobalMap map(0.02, 4096);
  map.place(drawn(0, {"     #", "     #", "     #"}), {});
  map.place(drawn(1, {"...#  ", "...#  ", "...#  "}), {});
  EXPECT_EQ(picture(map, 6, 3), (Rows{"...#  ", "...#  ", "...#  "}));
}

TEST(GlobalMap, DrawsNoMoreBlocksThanAllowed) {
  GlobalMap map(0.02, 4096);
  map.place(drawn(0, Rows(60, std::string(60, '.'))), {});
  const std::size_t left = map.redraw(1);
  EXPECT_GT(left, 0U);
  EXPECT_EQ(map.redraw(0), left);
  EXPECT_EQ(map.redraw(kAll), 0U);
}

TEST(GlobalMap, LetsGoOfMapsThatNothingShows) {
  GlobalMap map(0.02, 4096);
  const Rows room(60, std::string(60, '.'));
  std::size_t retired = 0;
  for (std::uint32_t id = 0; id < 100; ++id) {
    map.place(drawn(id, room), {});
    retired += map.retire(id).size();
  }
  EXPECT_EQ(map.active() + retired, 100U);
  EXPECT_LE(map.active(), HistoryMap::kMostMaps) << "what is kept depends on the building, not on the hours";
  EXPECT_EQ(picture(map, 60, 1).front(), std::string(60, '.'));
}

TEST(GlobalMap, TakesAMapOutAgain) {
  GlobalMap map(0.02, 4096);
  map.place(drawn(0, {"....", "...."}), {});
  map.place(drawn(1, {".##.", "...."}), {});
  map.remove(1);
  map.remove(77);
  EXPECT_EQ(picture(map, 4, 2), (Rows{"....", "...."}));
}

}  // namespace
}  // namespace dynslam
