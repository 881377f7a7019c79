// SPDX-License-Identifier: MIT
#include "io/tf_tree.h"

#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "base/angles.h"
#include "io/ros_messages.h"
#include "tests/io/mcap_builder.h"

namespace dynslam {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

const Quaterniond kNoTurn = Quaterniond::Identity();
const Quaterniond kQuarterLeft(Eigen::AngleAxisd(kPi / 2.0, Vector3d::UnitZ()));

TEST(TfTreeTest, ChainsFromTheRobotToTheFrame) {
  TfTree tree;
  EXPECT_TRUE(tree.add("mast", "laser", {0.5, 0.0, 0.1}, kNoTurn));
  EXPECT_TRUE(tree.add("base_link", "mast", {1.0, 2.0, 0.3}, kQuarterLeft));
  const auto robot_T_laser = tree.robot_T("laser");
  ASSERT_TRUE(robot_T_laser);
  EXPECT_TRUE(robot_T_laser->translation().isApprox(Vector3d(1.0, 2.5, 0.4)));
  EXPECT_TRUE(robot_T_laser->linear().isApprox(kQuarterLeft.toRotationMatrix()));
}

TEST(TfTreeTest, BaseLinkThenFootprintThenTheRoot) {
  TfTree tree;
  tree.add("base_link", "laser", {1.0, 0.0, 0.0}, kNoTurn);
  tree.add("base_footprint", "base_link", {10.0, 0.0, 0.0}, kNoTurn);
  tree.add("base_footprint", "imu", {2.0, 0.0, 0.0}, kNoTurn);
  tree.add("chassis", "base_footprint", {100.0, 0.0, 0.0}, kNoTurn);
  tree.add("chassis", "camera", {3.0, 0.0, 0.0}, kNoTurn);
  EXPECT_DOUBLE_EQ(tree.robot_T("laser")->translation().x(), 1.0);
  EXPECT_DOUBLE_EQ(tree.robot_T("imu")->translation().x(), 2.0);
  EXPECT_DOUBLE_EQ(tree.robot_T("camera")->translation().x(), 3.0);
  EXPECT_DOUBLE_EQ(tree.robot_T("base_link")->translation().x(), 0.0);
}

TEST(TfTreeTest, LeadingSlashDoesNotCount) {
  TfTree tree;
  tree.add("/base_link", "/laser", {1.0, 0.0, 0.0}, kNoTurn);
  EXPECT_TRUE(tree.robot_T("laser"));
  EXPECT_TRUE(tree.robot_T("/laser"));
}

TEST(TfTreeTest, UnknownFrameAndCircle) {
  TfTree tree;
  EXPECT_FALSE(tree.robot_T("laser"));
  EXPECT_FALSE(tree.robot_T(""));
  tree.add("a", "b", Vector3d::Zero(), kNoTurn);
  tree.add("b", "a", Vector3d::Zero(), kNoTurn);
  EXPECT_FALSE(tree.robot_T("a"));
  EXPECT_FALSE(tree.robot_T("laser"));
}

TEST(TfTreeTest, TheLastWordCounts) {
  TfTree tree;
  tree.add("base_link", "laser", {1.0, 0.0, 0.0}, kNoTurn);
  tree.add("base_link", "laser", {2.0, 0.0, 0.0}, kNoTurn);
  EXPECT_DOUBLE_EQ(tree.robot_T("laser")->translation().x(), 2.0);
}

TEST(TfTreeTest, RefusesWhatMakesNoSense) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  TfTree tree;
  EXPECT_FALSE(tree.add("", "a", Vector3d::Zero(), kNoTurn));
  EXPECT_FALSE(tree.add("a", "/", Vector3d::Zero(), kNoTurn));
  EXPECT_FALSE(tree.add("a", "/a", Vector3d::Zero(), kNoTurn));
  EXPECT_FALSE(tree.add("a", std::string(1000, 'x'), Vector3d::Zero(), kNoTurn));
  EXPECT_FALSE(tree.add("a", "b", {kNan, 0.0, 0.0}, kNoTurn));
  EXPECT_FALSE(tree.add("a", "b", {1e300, 0.0, 0.0}, kNoTurn));
  EXPECT_FALSE(tree.add("a", "b", Vector3d::Zero(), Quaterniond(0.0, 0.0, 0.0, 0.0)));
  EXPECT_FALSE(tree.add("a", "b", Vector3d::Zero(), Quaterniond(kNan, 0.0, 0.0, 0.0)));
}

TEST(TfTreeTest, IsBounded) {
  TfTree tree;
  for (std::size_t i = 0; i < TfTree::kMaxFrames; ++i) {
    EXPECT_TRUE(tree.add("base_link", std::to_string(i), Vector3d::Zero(), kNoTurn));
  }
  EXPECT_FALSE(tree.add("base_link", "one_more", Vector3d::Zero(), kNoTurn));
  EXPECT_TRUE(tree.add("base_link", "7", {1.0, 0.0, 0.0}, kNoTurn));
}

TEST(TfTreeTest, HeightsAreFromTheFloor) {
  TfTree tree;
  EXPECT_TRUE(tree.add("base_footprint", "base_link", {0.0, 0.0, 0.05}, kNoTurn));
  EXPECT_EQ(tree.height_m("laser"), std::nullopt);
  EXPECT_TRUE(tree.add("base_link", "laser", {0.1, 0.0, 0.2}, kNoTurn));
  EXPECT_NEAR(tree.height_m("/laser").value(), 0.25, 1e-12);
  EXPECT_TRUE(tree.add("tower", "camera", {0.0, 0.0, 0.7}, kNoTurn));
  EXPECT_EQ(tree.height_m("camera"), std::nullopt) << "it does not stand on the robot's floor";
  EXPECT_TRUE(tree.add("laser", "base_footprint", Vector3d::Zero(), kNoTurn));
  EXPECT_EQ(tree.height_m("laser"), std::nullopt) << "round in circles";
}

TEST(TfTreeTest, HeightsAreFromAFloorThatHangsFromTheRobotToo) {
  TfTree tree;
  EXPECT_TRUE(tree.add("base_link", "base_footprint", {0.0, 0.0, -0.05}, kNoTurn));
  EXPECT_TRUE(tree.add("base_link", "laser", {0.1, 0.0, 0.2}, kNoTurn));
  EXPECT_NEAR(tree.height_m("laser").value(), 0.25, 1e-12);
}

TEST(TfMessageTest, GoodTransformsAreTakenBesideABadOne) {
  const std::string bytes =
      test::transforms({{"base_link", "mast", 1.0}, {"mast", "mast"}, {"mast", "laser", 2.0}});
  TfTree tree;
  EXPECT_FALSE(decode_transforms({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}, tree));
  EXPECT_DOUBLE_EQ(tree.robot_T("laser")->translation().x(), 3.0);
}

TEST(TfMessageTest, HugeCountEndsWithTheMessage) {
  const std::string bytes = test::CdrWriter().put(0xFFFF'FFFFU).bytes();
  TfTree tree;
  EXPECT_FALSE(decode_transforms({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}, tree));
}

}  // namespace
}  // namespace dynslam
