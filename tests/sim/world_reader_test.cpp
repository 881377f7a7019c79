// SPDX-License-Identifier: MIT
#include <algorithm>

#include <gmock/gmock.h>

#include "base/error.h"
#include "sim/world.h"

namespace dynslam {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

/// What is wrong with a world of these lines, one text a problem.
std::vector<std::string> problems_of(const std::string& toml) {
  std::vector<std::string> lines(1);
  try {
    parse_world(toml, "w.toml");
    return {};
  } catch (const InputError& error) {
    for (const char* c = error.what(); *c != '\0'; ++c) {
      if (*c == '\n') {
        lines.emplace_back();
      } else {
        lines.back() += *c;
      }
    }
  }
  return lines;
}

const std::string kStart = "start = { at = [1, 1] }\n";  // line 1
const std::string kRoom =
    "wall = [ { points = [[0, 0], [4, 0], [4, 3], [0, 3]], closed = true } ]\n";  // line 2

TEST(WorldReader, ReadsTheWorldsThatComeWithTheProgram) {
  EXPECT_THAT(builtin_world_names(), ElementsAre("apartment", "office", "clutter", "warehouse", "empty"));
  for (const std::string& name : builtin_world_names()) {
    const World world = load_world(name);
    EXPECT_EQ(world.name, name);
    EXPECT_FALSE(world.walls.empty()) << name;
    EXPECT_GE(world.tour.size(), 5U) << name;
  }
}

TEST(WorldReader, AnApartmentHasWhatTheNameSays) {
  const World world = load_world("apartment");
  EXPECT_GE(world.doors.size(), 5U);
  EXPECT_GE(world.people.size(), 1U);
  EXPECT_GE(world.doorsteps.size(), 1U);
  const auto closes_and_reopens = [](const Door& d) {
    return d.schedule.size() == 2 && d.schedule[0].open == 0 && d.schedule[1].open == 1;
  };
  EXPECT_TRUE(std::any_of(world.doors.begin(), world.doors.end(), closes_and_reopens));
}

TEST(WorldReader, NamesTheWorldsWhenOneIsUnknown) {
  try {
    load_world("castle");
    FAIL() << "there is no such world";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("apartment, office"));
  }
  EXPECT_THROW(load_world("/nonexistent/world.toml"), InputError);
  EXPECT_THROW(load_world("/"), InputError);
}

TEST(WorldReader, TakesASmallWorld) { EXPECT_THAT(problems_of(kStart + kRoom), IsEmpty()); }

TEST(WorldReader, TellsAllProblemsAtOnceWithTheirLines) {
  const auto problems = problems_of(
      "start = { at = [1, 1] }\n"
      "tours = 3\n"
      "[[wall]]\n"
      "points = [[0, 0], [4, 0], [4, 3], [0, 3]]\n"
      "closed = 1\n"
      "[[wall]]\n"
      "points = [[1, 2], [nan, 2]]\n"
      "[[wall]]\n"
      "points = [[2, -1], [2, 2]]\n"
      "thickness_m = -0.1\n"
      "[[furniture]]\n"
      "shape = \"cube\"\n"
      "at = [1, \"two\"]\n"
      "[[furniture]]\n"
      "shape = \"box\"\n"
      "at = [3, 2]\n"
      "size_m = [0, 0.5]\n");
  EXPECT_THAT(problems, Contains("w.toml:2: world: unknown key tours; the nearest known key is tour"));
  EXPECT_THAT(problems, Contains("w.toml:5: wall: closed must be true or false"));
  EXPECT_THAT(problems,
              Contains(StartsWith("w.toml:7: wall: points must be made of arrays of 2 finite numbers")));
  EXPECT_THAT(problems, Contains(StartsWith("w.toml:8: wall: crosses the wall of line 3 at (2.00, 0.00)")));
  EXPECT_THAT(problems,
              Contains(StartsWith("w.toml:10: wall: thickness_m must be a number from 0.01 to 2, not -0.1")));
  EXPECT_THAT(problems, Contains(StartsWith("w.toml:12: furniture: shape must be one of")));
  EXPECT_THAT(problems, Contains(StartsWith("w.toml:13: furniture: at must be [x, y]")));
  EXPECT_THAT(problems, Contains(StartsWith("w.toml:17: furniture: size_m must be [length, width]")));
}

TEST(WorldReader, SaysWhereTheFileIsNoToml) {
  EXPECT_THAT(problems_of("start = { at = [1, 1] }\nwall = [[[\n"), ElementsAre(StartsWith("w.toml:")));
}

TEST(WorldReader, WantsDoorsToSitInAnOpening) {
  const std::string wall = "wall = [ { points = [[0, 2], [1, 2]] }, { points = [[2, 2], [3, 2]] } ]\n";
  const auto with_door = [&](const std::string& ends) {
    return problems_of(kStart + wall + "door = [ { name = \"d\", " + ends + " } ]\n");
  };
  EXPECT_THAT(with_door("hinge = [1, 2], latch = [2, 2]"), IsEmpty());
  EXPECT_THAT(with_door("hinge = [1, 3], latch = [2, 3]"),
              Contains("w.toml:3: door \"d\": no wall ends at its hinge (1.00, 3.00)"));
  EXPECT_THAT(with_door("hinge = [0, 2], latch = [1, 2]"),
              Contains("w.toml:3: door \"d\": there is no opening: the wall of line 2 fills it"));
  EXPECT_THAT(with_door("hinge = [1, 2], latch = [1.1, 2]"),
              Contains(HasSubstr("a door needs 0.3 m or more")));
  EXPECT_THAT(with_door("hinge = [1, 2]"), Contains("w.toml:3: door \"d\": latch is missing"));
}

TEST(WorldReader, LetsNobodyWalkThroughWallsOrCupboards) {
  const auto walking = [](const std::string& route) {
    return problems_of(
        kStart + kRoom +
        "furniture = [ { shape = \"box\", at = [3, 1.5] } ]\nperson = [ { name = \"p\", route = " + route +
        " } ]\n");
  };
  EXPECT_THAT(walking("[[2, 1], [2, 2]]"), IsEmpty());
  EXPECT_THAT(
      walking("[[2, 1], [2, 4]]"),
      ElementsAre(
          "w.toml:4: person \"p\": walks through the wall of line 2 between (2.00, 1.00) and (2.00, 4.00)"));
  EXPECT_THAT(walking("[[2, 1.5], [3.7, 1.5]]"), ElementsAre(HasSubstr("walks through box of line 3")));
  EXPECT_THAT(walking("[[2, 1]]"), ElementsAre(HasSubstr("route must be at least 2 points")));
}

TEST(WorldReader, WantsRoomForStartAndTour) {
  EXPECT_THAT(problems_of("start = { at = [0.05, 1] }\n" + kRoom),
              ElementsAre("w.toml:1: start: the robot would stand in the wall of line 2"));
  EXPECT_THAT(problems_of(kStart + kRoom + "tour = [[2, 1], [5, 1]]\n"),
              ElementsAre("w.toml:3: tour: meets the wall of line 2 between (2.00, 1.00) and (5.00, 1.00)"));
  EXPECT_THAT(problems_of(kRoom), ElementsAre(HasSubstr("start is missing")));
  const std::string table = "furniture = [ { shape = \"table\", at = [2, 1] } ]\n";
  EXPECT_THAT(problems_of(kStart + kRoom + "tour = [[3, 1]]\n" + table), IsEmpty()) << "it drives underneath";
}

TEST(WorldReader, CopiesFurniture) {
  const World world = parse_world(
      kStart + kRoom +
          "furniture = [ { shape = \"box\", at = [2, 2], copies = { count = 3, step = [0.6, 0] } } ]\n",
      "w");
  ASSERT_EQ(world.furniture.size(), 3U);
  EXPECT_NEAR(world.furniture[2].world_T_thing.x, 3.2, 1e-12);
}

TEST(WorldReader, RefusesFaultsThatADeviceCannotHave) {
  const auto fault = [](const std::string& text) {
    return problems_of(kStart + "fault = [ { " + text + " } ]\n");
  };
  EXPECT_THAT(fault("device = \"lidar\", kind = \"mirrored\", at_s = 3"), IsEmpty());
  EXPECT_THAT(fault("device = \"pins\", kind = \"nan\", at_s = 3"),
              ElementsAre(HasSubstr("cannot fail in this way")));
  EXPECT_THAT(fault("device = \"imu\", kind = \"frozen\", at_s = 3, until_s = 2"),
              ElementsAre(HasSubstr("until_s must be after at_s")));
}

TEST(WorldReader, RefusesTimesThatGoBack) {
  EXPECT_THAT(
      problems_of(
          kStart + kRoom +
          "furniture = [ { shape = \"box\", at = [3, 2], moves = [ { at_s = 5, to = [2, 2] }, { at_s = 6, to "
          "= [3, 2] } ] } ]\n"),
      Contains(HasSubstr("begins before the move before it has ended")));
}

TEST(WorldPicture, ShowsWhatThereIs) {
  const std::string svg = to_svg(load_world("apartment"));
  EXPECT_THAT(svg, StartsWith("<svg "));
  EXPECT_THAT(svg, HasSubstr("</svg>"));
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
}

}  // namespace
}  // namespace dynslam
