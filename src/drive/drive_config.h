// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "drive/battery_watch.h"
#include "drive/body_config.h"
#include "drive/clearance.h"
#include "drive/follower_config.h"
#include "drive/heartbeat.h"
#include "drive/kinematics.h"
#include "drive/safety_config.h"

namespace dynslam {

/// All that can be set about driving: a table for each.
struct DriveConfig {
  BodyConfig body;
  HeartbeatConfig heartbeat;
  KinematicsConfig kinematics;
  ClearanceConfig clearance;
  BatteryConfig battery;
  SafetyConfig safety;
  FollowerConfig follower;

  /// Calls `visit(name of the table, struct with fields)` for each table.
  template <class Self, class Visit>
  static void sections(Self& self, Visit&& visit) {
    visit(std::string_view("body"), self.body);
    visit(std::string_view("heartbeat"), self.heartbeat);
    visit(std::string_view("kinematics"), self.kinematics);
    visit(std::string_view("clearance"), self.clearance);
    visit(std::string_view("battery"), self.battery);
    visit(std::string_view("safety"), self.safety);
    visit(std::string_view("follower"), self.follower);
  }
};

}  // namespace dynslam
