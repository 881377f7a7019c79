// SPDX-License-Identifier: MIT
#include "io/map_file.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "io/drawn_map.h"

namespace dynslam {
namespace {

std::string pixels(const std::vector<int>& values) { return {values.begin(), values.end()}; }

TEST(ToPgm, PutsTheHighestYOnTop) {
  const TrinaryMap map = drawn_map({"#. ",  //
                                    ".##"});
  EXPECT_EQ(to_pgm(map), "P5\n3 2\n255\n" + pixels({0, 254, 205,  //
                                                    254, 0, 0}));
}

TEST(ToPgm, DoesNotDependOnTheOrigin) {
  EXPECT_EQ(to_pgm(drawn_map({"#. "}, {-70, 1000})), to_pgm(drawn_map({"#. "})));
}

TEST(ToPgm, MakesAnEmptyMapOneUnknownPixel) {
  EXPECT_EQ(to_pgm(drawn_map({})), "P5\n1 1\n255\n" + pixels({205}));
}

TEST(WritePgm, GoesOutRowByRow) {
  std::size_t longest = 0;
  write_pgm(drawn_map({"....", "....", "....", "...."}),
            [&](std::string_view piece) { longest = std::max(longest, piece.size()); });
  EXPECT_LE(longest, 11U);
}

TEST(ToMapYaml, SaysWhatMapServerReads) {
  EXPECT_EQ(to_map_yaml(drawn_map({"."}, {-61, 35}, 0.02), "map.pgm"),
            "image: map.pgm\n"
            "mode: trinary\n"
            "resolution: 0.02\n"
            "origin: [-1.22, 0.7, 0]\n"
            "negate: 0\n"
            "occupied_thresh: 0.65\n"
            "free_thresh: 0.196\n");
}

TEST(ToMapYaml, WritesPlainDecimals) {
  EXPECT_NE(to_map_yaml(drawn_map({"."}, {0, 1}, 0.00001), "a")
                .find("resolution: 0.00001\norigin: [0.0, 0.00001, 0]"),
            std::string::npos);
}

TEST(ToMapYaml, QuotesAnOddImageName) {
  EXPECT_EQ(to_map_yaml({}, "a: b's.pgm").substr(0, 21), "image: 'a: b''s.pgm'\n");
  EXPECT_EQ(to_map_yaml({}, "").substr(0, 10), "image: ''\n");
}

}  // namespace
}  // namespace dynslam
