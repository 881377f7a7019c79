// SPDX-License-Identifier: MIT
#include "server/seats.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/rate_limit.h"

namespace dynslam {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using Use = Seats::Use;

Seats::SteadyTime at(double s) {
  return Seats::SteadyTime(
      std::chrono::duration_cast<Seats::SteadyTime::duration>(std::chrono::duration<double>(s)));
}

std::vector<Seats::Id> overdue(const Seats& seats, double s) {
  return seats.overdue(at(s), [](Seats::Id) { return true; });
}

TEST(Seats, AnAddressGetsItsShare) {
  Seats seats({10, 2, 3});
  for (int i = 0; i < 3; ++i) EXPECT_NE(seats.open("a", at(0)), 0U);
  EXPECT_EQ(seats.open("a", at(0)), 0U);
  const Seats::Id other = seats.open("b", at(0));
  EXPECT_NE(other, 0U);
  seats.close(1);
  EXPECT_NE(seats.open("a", at(0)), 0U);
  EXPECT_EQ(seats.refused(), 1U);
  EXPECT_EQ(seats.taken(), 4U);
}

TEST(Seats, TheLastOnesAreForDrivingAndTheVeryLastForStop) {
  Seats seats({10, 4, 20});
  const auto enter = [&](Use use) { return seats.use(seats.open("a", at(0)), use, at(0)); };
  for (int i = 0; i < 6; ++i) EXPECT_TRUE(enter(Use::kWatch));
  EXPECT_FALSE(enter(Use::kWatch)) << "four are kept";
  EXPECT_TRUE(enter(Use::kControl)) << "two are kept still";
  EXPECT_FALSE(enter(Use::kRequest));
  EXPECT_FALSE(enter(Use::kControl));
  EXPECT_TRUE(enter(Use::kStop));
  EXPECT_EQ(seats.refused(), 3U);
  for (Seats::Id id = 1; id <= 6; ++id) seats.close(id);
  EXPECT_TRUE(enter(Use::kControl));
}

TEST(Seats, WhoAsksForNothingNeverStandsInTheWay) {
  Seats seats({10, 4, 100});
  for (int i = 0; i < 50; ++i) seats.open("a", at(0));  // more than there are: they wait for one
  EXPECT_TRUE(seats.use(7, Use::kControl, at(0)));
  EXPECT_TRUE(seats.use(8, Use::kRequest, at(0)));
}

TEST(Seats, WhoHasAskedButWasNotHeardYetIsNotCut) {
  Seats seats({4, 2, 4});
  for (int i = 0; i < 4; ++i) seats.open("a", at(0));
  EXPECT_THAT(seats.overdue(at(1), [](Seats::Id id) { return id != 1 && id != 2; }), ElementsAre(3, 4));
}

TEST(Seats, WhoAsksForNothingMakesRoomTheOldestFirst) {
  Seats seats({6, 2, 6});
  for (int i = 0; i < 4; ++i) seats.open("a", at(i));
  seats.use(2, Use::kWatch, at(4));
  EXPECT_THAT(overdue(seats, 4), IsEmpty());
  seats.open("b", at(4));
  EXPECT_THAT(overdue(seats, 4), ElementsAre(1));
  seats.open("b", at(4));
  EXPECT_THAT(overdue(seats, 4), ElementsAre(1, 3)) << "2 looks on";
  seats.open("b", at(4));
  EXPECT_THAT(overdue(seats, 4.1), ElementsAre(1, 3)) << "the others have only come";
  EXPECT_THAT(overdue(seats, 4.3), ElementsAre(1, 3));
}

TEST(Seats, NobodyKeepsASeatForNothing) {
  Seats seats({10, 2, 10});
  seats.open("a", at(0));
  seats.use(seats.open("a", at(0)), Use::kRequest, at(0));
  seats.use(seats.open("a", at(0)), Use::kDownload, at(0));
  seats.use(seats.open("a", at(0)), Use::kControl, at(0));
  EXPECT_THAT(overdue(seats, 4.9), IsEmpty());
  EXPECT_THAT(overdue(seats, 5.1), ElementsAre(1));
  EXPECT_THAT(overdue(seats, 20.1), ElementsAre(1, 2));
  EXPECT_THAT(overdue(seats, 1e4), ElementsAre(1, 2));
}

TEST(Seats, WhoIsGoneHasNoUse) {
  Seats seats({10, 2, 10});
  EXPECT_FALSE(seats.use(1, Use::kStop, at(0)));
  seats.close(1);
  EXPECT_EQ(seats.taken(), 0U);
}

TEST(RateLimit, LetsABurstPassAndThenSoManyASecond) {
  RateLimit limit(10.0, 5.0);
  const auto passed = [&](double from_s, double until_s, double step_s) {
    int n = 0;
    for (double t = from_s; t < until_s; t += step_s) n += limit.pass(time_at_s(t)) ? 1 : 0;
    return n;
  };
  EXPECT_EQ(passed(100.0, 100.0001, 0.00001), 5);
  EXPECT_NEAR(passed(100.1, 110.0, 0.001), 100, 2);
  EXPECT_FALSE(limit.pass(time_at_s(50.0))) << "a clock that runs backwards";
}

}  // namespace
}  // namespace dynslam
