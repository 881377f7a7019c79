// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "base/counters.h"
#include "robot/ports.h"

namespace dynslam {

/// The nearest return of a scan in each degree around the robot, centimetres; 0: none. Degree 0 is straight
/// ahead, 90 to the left.
std::array<std::uint16_t, 360> coarse_ranges_cm(const Scan& scan);

/// What is told of the robot besides what its ports say.
struct StateExtras {
  Time now;
  std::uint64_t scan_version = 0;
  std::optional<std::string> driver;  ///< who holds the wheel
  Counters counters;                  ///< of the server
  std::string map_id;
  std::uint64_t notes_version = 0;  ///< counts the changes of what people drew
};

/// The state as web/openapi.yaml describes it.
nlohmann::json state_json(const Ports& ports, const StateExtras& extras);

/// Where the local maps lie, and the closures.
nlohmann::json graph_json(const Ports& ports);

/// The last lines of the log.
nlohmann::json log_json(const Ports& ports);

/// What is recorded now; null before the recorder has said anything.
nlohmann::json recording_json(const Ports& ports);

/// How each device does, and what the robot's stages count.
nlohmann::json devices_json(const Ports& ports);

/// As sent; what is not UTF-8 in it is replaced.
std::string text_of(const nlohmann::json& message);

}  // namespace dynslam
