// SPDX-License-Identifier: MIT
#include "io/trajectory.h"

#include <limits>
#include <locale>

#include <gtest/gtest.h>

namespace dynslam {
namespace {

Time at_ns(std::int64_t count) { return Time(Duration(count)); }

TEST(ToTum, IsEmptyForNoPoses) { EXPECT_EQ(to_tum({}), ""); }

TEST(ToTum, WritesALineAPose) {
  EXPECT_EQ(to_tum({{at_ns(1'500'000'000), {1.25, -2.0, 0.0}}, {at_ns(2'000'000'000), {0.0, 0.5, kPi}}}),
            "1.500000000 1.250000 -2.000000 0 0 0 0.000000000 1.000000000\n"
            "2.000000000 0.000000 0.500000 0 0 0 1.000000000 0.000000000\n");
}

TEST(ToTum, KeepsEveryNanosecondOfAStampOfToday) {
  EXPECT_EQ(to_tum({{at_ns(1'700'001'000'049'974'539), {}}}).substr(0, 20), "1700001000.049974539");
}

TEST(ToTum, WritesStampsBeforeTheEpoch) {
  EXPECT_EQ(to_tum({{at_ns(-1), {}}}).substr(0, 12), "-0.000000001");
  EXPECT_EQ(to_tum({{at_ns(-2'000'000'003), {}}}).substr(0, 12), "-2.000000003");
}

TEST(ToTum, TurnsYawIntoAQuaternionAboutZ) {
  EXPECT_EQ(to_tum({{at_ns(0), {0.0, 0.0, radians(-90.0)}}}),
            "0.000000000 0.000000 0.000000 0 0 0 -0.707106781 0.707106781\n");
}

TEST(ToTum, KeepsTheMicrometreFarAway) {
  EXPECT_EQ(to_tum({{at_ns(0), {12345.000001, -0.000001, 0.0}}}).substr(12, 22), "12345.000001 -0.000001");
}

TEST(ToTum, HasRoomForAnyNumber) {
  EXPECT_GT(to_tum({{at_ns(0), {-std::numeric_limits<double>::max(), 0.0, 0.0}}}).size(), 310U);
}

struct CommaForPoint : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

TEST(ToTum, WritesAPointInAnyLocale) {
  const std::locale before = std::locale::global(std::locale(std::locale(), new CommaForPoint));
  const std::string text = to_tum({{at_ns(4'000'500'000'000), {1234.5, 0.0, 0.0}}});
  std::locale::global(before);
  EXPECT_EQ(text.substr(0, 26), "4000.500000000 1234.500000");
}

}  // namespace
}  // namespace dynslam
