// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <variant>

#include "base/drive_command.h"
#include "base/imu_sample.h"
#include "base/jpeg_frame.h"
#include "base/odometry.h"
#include "base/scan.h"
#include "io/ros_writer.h"
#include "robot/ports.h"

namespace dynslam {

/// One thing that a recording holds, and when the robot heard of it.
struct RecorderEvent {
  Time time;
  std::variant<std::shared_ptr<const Scan>, ImuSample, OdometrySample, PoseFix, DriveCommand,
               std::shared_ptr<const DriveState>, std::shared_ptr<const JpegFrame>>
      what;
};

}  // namespace dynslam
