// SPDX-License-Identifier: MIT
#include "grid/history_map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace dynslam {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(HistoryMap, KnowsNothingWhereNoMapWas) {
  HistoryMap history;
  EXPECT_THAT(history.maps_at({3, 4}), IsEmpty());
  history.cover({3, 4}, 7, 0.0);
  EXPECT_THAT(history.maps_at({3, 4}), IsEmpty());
}

TEST(HistoryMap, ANewerMapThatSeesAllTakesAPlaceOver) {
  HistoryMap history;
  for (std::uint32_t id = 1; id <= 9; ++id) history.cover({0, 0}, id, 0.9);
  EXPECT_THAT(history.maps_at({0, 0}), ElementsAre(9, 8, 7, 6, 5, 4))
      << "and those below fill in what it left open";
  EXPECT_EQ(history.named(), (std::set<std::uint32_t>{4, 5, 6, 7, 8, 9}));
}

TEST(HistoryMap, ANewerMapThatSeesLessDoesNot) {
  HistoryMap history;
  history.cover({0, 0}, 1, 1.0);
  history.cover({0, 0}, 2, 1.0);
  history.cover({0, 0}, 3, 0.3);
  history.cover({0, 0}, 4, 0.74);
  EXPECT_THAT(history.maps_at({0, 0}), ElementsAre(4, 3, 2, 1));
}

TEST(HistoryMap, TakesMapsInAnyOrderAndTheLatestWordOnOne) {
  HistoryMap history;
  history.cover({0, 0}, 4, 0.2);
  history.cover({0, 0}, 2, 0.2);
  history.cover({0, 0}, 3, 0.2);
  EXPECT_THAT(history.maps_at({0, 0}), ElementsAre(4, 3, 2));
  for (std::uint32_t id = 3; id < 3 + HistoryMap::kLayers; ++id) history.cover({0, 0}, id, 0.9);
  EXPECT_THAT(history.maps_at({0, 0}), ElementsAre(8, 7, 6, 5, 4, 3));
}

TEST(HistoryMap, StaysShortWhereManyMapsSawALittle) {
  HistoryMap history;
  history.cover({0, 0}, 1, 1.0);
  for (std::uint32_t id = 2; id < 40; ++id) history.cover({0, 0}, id, 0.1);
  EXPECT_EQ(history.maps_at({0, 0}).size(), HistoryMap::kMostMaps);
  EXPECT_EQ(history.maps_at({0, 0}).front(), 39U);
  EXPECT_EQ(history.maps_at({0, 0}).back(), 1U) << "the one that saw all is kept";
}

TEST(HistoryMap, ForgetsWhenAsked) {
  HistoryMap history;
  history.cover({0, 0}, 1, 1.0);
  history.clear();
  EXPECT_EQ(history.size(), 0U);
}

}  // namespace
}  // namespace dynslam
