// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace dynslam {

/// How a message of ROS 2 is laid out, as MCAP wants it told (encoding `ros2msg`): the fields, then those of
/// each type in it. `type` as in "sensor_msgs/LaserScan". REQUIRES: one of the types that are recorded.
std::string ros_schema(std::string_view type);

}  // namespace dynslam
