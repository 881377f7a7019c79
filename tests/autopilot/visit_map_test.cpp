// SPDX-License-Identifier: MIT
#include "autopilot/visit_map.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace dynslam {
namespace {

TEST(VisitMap, RemembersTheLastVisitOfEachCell) {
  VisitMap visits;
  visits.note(time_at_s(1), {0.1, 0.1});
  visits.note(time_at_s(2), {-0.1, 0.6});
  visits.note(time_at_s(3), {0.49, 0.0});
  EXPECT_EQ(visits.last_visit({0, 0}), time_at_s(3));
  EXPECT_EQ(visits.last_visit({-1, 1}), time_at_s(2));
  EXPECT_EQ(visits.last_visit({1, 0}), std::nullopt);
  ASSERT_EQ(visits.by_age().size(), 2U);
  EXPECT_EQ(visits.by_age().begin()->second, (CellIndex{-1, 1}));
}

TEST(VisitMap, ForgetsTheOldestBeyondItsBounds) {
  VisitMap visits(3);
  for (int i = 0; i < 4; ++i) {
    visits.note(time_at_s(10 + i), {0.25 + 0.5 * i, 0.0});
    visits.note(time_at_s(10 + i), {0.25, 0.0});
  }
  EXPECT_EQ(visits.by_age().size(), 3U);
  EXPECT_EQ(visits.last_visit({0, 0}), time_at_s(13)) << "it comes back to this one";
  EXPECT_EQ(visits.last_visit({1, 0}), std::nullopt);
  EXPECT_EQ(visits.last_visit({3, 0}), time_at_s(13));
}

TEST(VisitMap, PassesOverNonsense) {
  VisitMap visits;
  for (const double nonsense : {std::nan(""), std::numeric_limits<double>::infinity(), -1e300, 1e12}) {
    visits.note(Time(), {nonsense, 0.0});
    visits.note(Time(), {0.0, nonsense});
  }
  EXPECT_TRUE(visits.by_age().empty());
}

}  // namespace
}  // namespace dynslam
