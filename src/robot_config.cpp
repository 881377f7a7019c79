// SPDX-License-Identifier: MIT
#include "robot_config.h"

#include <nlohmann/json.hpp>

namespace dynslam {

RobotConfig robot_config(const Config& config) {
  RobotConfig robot;
  robot.slam = config.slam;
  robot.drive = config.drive;
  robot.lidar_mount = config.lidar.mount();
  robot.autopilot = {config.autopilot, config.navigation, config.exploration, config.planner,
                     config.drive.body.radius_m()};
  robot.recorder = config.recorder;
  robot.recording_about = {"dynslam " DYNSLAM_VERSION, {{"config", config_json(config).dump()}}};
  return robot;
}

}  // namespace dynslam
