// SPDX-License-Identifier: MIT
#include "robot_config.h"

#include <nlohmann/json.hpp>

namespace dynslam {

RobotConfig robot_config(const Config& config) {
  RobotConfig robot;
  robot.slam = config.slam;
  robot.drive = config.drive;
  robot.lidar_mount = config.lidar.mount();
  robot.recorder = config.recorder;
  robot.recording_about = {"dynslam " DYNSLAM_VERSION, {{"config", config_json(config).dump()}}};
  return robot;
}

}  // namespace dynslam
