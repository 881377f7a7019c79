// SPDX-License-Identifier: MIT
#include "io/ros_schema.h"

#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace dynslam {
namespace {

using testing::HasSubstr;

TEST(RosSchema, HasEachTypeWithinOnce) {
  const std::string text = ros_schema("nav_msgs/Odometry");
  for (const char* type :
       {"std_msgs/Header", "builtin_interfaces/Time", "geometry_msgs/PoseWithCovariance",
        "geometry_msgs/Pose", "geometry_msgs/Point", "geometry_msgs/Quaternion",
        "geometry_msgs/TwistWithCovariance", "geometry_msgs/Twist", "geometry_msgs/Vector3"}) {
    const std::string head = std::string(80, '=') + "\nMSG: " + type + "\n";
    const std::size_t at = text.find(head);
    EXPECT_NE(at, std::string::npos) << type;
    EXPECT_EQ(text.find(head, at + 1), std::string::npos) << type;
  }
  EXPECT_EQ(text.find("std_msgs/Header header\nstring child_frame_id\n"), 0U);
}

TEST(RosSchema, FindsTypesInSequences) {
  EXPECT_THAT(ros_schema("tf2_msgs/TFMessage"), HasSubstr("MSG: geometry_msgs/TransformStamped\n"));
}

TEST(RosSchema, KnowsNoOthers) { EXPECT_THROW(ros_schema("std_msgs/String"), std::logic_error); }

}  // namespace
}  // namespace dynslam
