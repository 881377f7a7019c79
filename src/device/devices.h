// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "device/camera.h"
#include "device/imu.h"
#include "device/lidar.h"
#include "device/motors.h"
#include "device/pins.h"
#include "device/wheels.h"

namespace dynslam {

/// All hardware of a robot. What a robot does not have is null; it needs lidar and motors to drive.
struct Devices {
  std::unique_ptr<Lidar> lidar;
  std::unique_ptr<Imu> imu;
  std::unique_ptr<Motors> motors;
  std::unique_ptr<Camera> camera;
  std::unique_ptr<Pins> pins;
  std::unique_ptr<Wheels> wheels;  ///< what counts their turns
};

}  // namespace dynslam
