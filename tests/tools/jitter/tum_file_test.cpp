// SPDX-License-Identifier: MIT
#include "tools/jitter/tum_file.h"

#include <sstream>

#include <Eigen/Geometry>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "support_matchers.h"

namespace dynslam::jitter {
namespace {

using ::testing::HasSubstr;

std::vector<StampedPose> read(std::string text) {
  MemorySource source(std::move(text), "way.tum");
  return read_tum(source);
}

/// What the reader has to say against a text.
std::string complaint(std::string text) {
  try {
    read(std::move(text));
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(ReadTum, ReadsWhatIsWritten) {
  const std::vector<StampedPose> written = {{time_at_s(1.5), {1.25, -2.0, 0.5}},
                                            {time_at_s(1.75), {-1e4, 0, -3.0}}};
  const std::vector<StampedPose> way = read(to_tum(written));
  ASSERT_EQ(way.size(), 2U);
  for (std::size_t i = 0; i < way.size(); ++i) {
    EXPECT_EQ(way[i].stamp, written[i].stamp);
    EXPECT_THAT(way[i].map_T_robot, PoseNear(written[i].map_T_robot, 1e-6, 1e-6));
  }
}

TEST(ReadTum, PassesOverCommentsAndBlankLines) {
  const auto way = read("# t x y z qx qy qz qw\n\n \t\n1 2 3 0 0 0 0 1 # here\r\n");
  ASSERT_EQ(way.size(), 1U);
  EXPECT_THAT(way[0].map_T_robot, PoseNear(Pose2{2, 3, 0}, 0, 0));
}

TEST(ReadTum, TakesTheHeadingOfATiltedPoseAndAShortQuaternion) {
  EXPECT_NEAR(read("1 0 0 5 0 0 0.69 0.69\n")[0].map_T_robot.yaw, kPi / 2, 1e-9);
  const Eigen::Quaterniond q =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitY());
  std::ostringstream line;
  line.precision(17);
  line << "1 0 0 0 " << q.x() << ' ' << q.y() << ' ' << q.z() << ' ' << q.w();
  EXPECT_NEAR(read(line.str())[0].map_T_robot.yaw, 0.7, 1e-9);
}

TEST(ReadTum, NamesFileLineAndFault) {
  const std::string good = "1 2 3 0 0 0 0 1\n";
  for (const char* bad : {"1 2 3 0 0 0 1", "1 2 3 0 0 0 0 1 9", "1 2 3 0 0 0 0 one", "1 nan 3 0 0 0 0 1",
                          "1 2,5 3 0 0 0 0 1", "1 1e999 3 0 0 0 0 1"})
    EXPECT_EQ(complaint(good + bad), "way.tum:2: want 8 numbers: t x y z qx qy qz qw") << bad;
  EXPECT_EQ(complaint("1e10 2 3 0 0 0 0 1"), "way.tum:1: the time is out of range");
  for (const char* bad : {"1 2 3 0 0 0 0 0", "1 2 3 0 0 0 0 1.1", "1 2 3 0 1e300 0 0 1"})
    EXPECT_THAT(complaint(good + good + bad), HasSubstr("way.tum:3: the quaternion's length")) << bad;
}

TEST(ReadTum, RefusesATextWithoutPoses) {
  EXPECT_EQ(complaint(""), "way.tum: holds no pose");
  EXPECT_EQ(complaint("# only words\n"), "way.tum: holds no pose");
}

TEST(ReadTum, RefusesABrokenArchive) {
  EXPECT_THAT(complaint(std::string("\x1f\x8b\x08") + "rest"), HasSubstr("way.tum: "));
}

}  // namespace
}  // namespace dynslam::jitter
