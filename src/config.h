// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "autopilot/autopilot.h"
#include "base/config_field.h"
#include "base/error.h"
#include "base/scan.h"
#include "drive/drive_config.h"
#include "hardware_config.h"
#include "robot/recorder_config.h"
#include "server/access/access_config.h"
#include "server/server_config.h"
#include "slam/slam_config.h"

namespace dynslam {

/// Where the lidar sits, for recordings and drivers that do not say it themselves.
struct LidarConfig {
  double x_m = 0.0;
  double y_m = 0.0;
  double yaw_rad = 0.0;
  bool upside_down = false;
  double height_m = 0.18;

  LidarMount mount() const { return {{x_m, y_m, wrap_angle(yaw_rad)}, upside_down, height_m}; }

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"x_m", "how far the lidar is ahead of the middle of the axle", -5.0, 5.0}, self.x_m);
    visit(Field{"y_m", "how far the lidar is to the left of the middle of the axle", -5.0, 5.0}, self.y_m);
    visit(Field{"yaw_rad", "how far the lidar's forward is turned to the left", -6.3, 6.3}, self.yaw_rad);
    visit(Field{"upside_down", "whether the lidar hangs head down"}, self.upside_down);
    visit(Field{"height_m", "how high above the floor the lidar looks", 0.02, 3.0}, self.height_m);
  }
};

/// The whole TOML file: a table for each class that has something to set. What the file leaves out keeps its
/// default.
struct Config {
  LidarConfig lidar;
  SlamConfig slam;
  DriveConfig drive;
  ServerConfig server;
  RecorderConfig recorder;
  AccessConfig access;
  AutopilotConfig autopilot;
  NavigationConfig navigation;
  ExplorationConfig exploration;
  PlannerConfig planner;
  HardwareConfig hardware;
  StateConfig state;
  std::vector<std::string> warnings;  ///< FILE:LINE: key: what has changed since the file was written

  /// Calls `visit(name of the table, struct with fields)` for each table.
  template <class Self, class Visit>
  static void sections(Self& self, Visit&& visit) {
    visit(std::string_view("lidar"), self.lidar);
    visit(std::string_view("slam"), self.slam);
    DriveConfig::sections(self.drive, visit);
    visit(std::string_view("server"), self.server);
    visit(std::string_view("recorder"), self.recorder);
    visit(std::string_view("access"), self.access);
    visit(std::string_view("autopilot"), self.autopilot);
    visit(std::string_view("navigation"), self.navigation);
    visit(std::string_view("exploration"), self.exploration);
    visit(std::string_view("planner"), self.planner);
    HardwareConfig::sections(self.hardware, visit);
    visit(std::string_view("state"), self.state);
  }
};

/// Everything that is wrong with a config at once; what() has a line for each problem.
struct ConfigError : InputError {
  explicit ConfigError(std::vector<std::string> all_problems);
  std::vector<std::string> problems;  ///< FILE:LINE: key: what is wrong; at least one
};

/// The config that a file and then the `--set` texts give; without a file the defaults. Throws ConfigError
/// with the problems of both, InputError when the file cannot be read.
Config make_config(const std::optional<std::string>& path, const std::vector<std::string>& settings);

/// Throws ConfigError for what the file says, InputError when it cannot be read.
Config load_config(const std::string& path);

/// One `--set` text, "section.key=value", the value written as in the file; a string may go without its
/// quotes. Throws ConfigError and then leaves `config` as it was.
void apply_setting(Config& config, std::string_view setting);

/// The config as a commented TOML file that load_config() reads back to the same values.
std::string config_reference(const Config& config);

/// The config as {"section": {"key": value}}.
nlohmann::json config_json(const Config& config);

}  // namespace dynslam
