// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "autopilot/order.h"

namespace dynslam {

inline constexpr std::size_t kMostPlaces = 64, kMostAreas = 64, kLeastCorners = 3, kMostCorners = 64;
inline constexpr std::size_t kLongestNoteName = 40;
inline constexpr double kFarthestNote_m = 1000.0;

/// An area that the robot keeps out of; its outline may cross itself.
struct NoGoArea {
  std::string name;
  std::vector<Vector2> corners_map;
};

/// What people drew on a map, places and areas by name.
struct Notes {
  std::string map_id;
  std::string notice;  ///< what people should know of these notes; empty: nothing
  std::optional<Destination> home = {};
  std::vector<Destination> places = {};
  std::vector<NoGoArea> areas = {};

  bool is_empty() const { return !home && places.empty() && areas.empty(); }
  MapNotes for_robot() const;
};

/// Why something cannot be noted, in one sentence; nothing when it can. A name is a step of a path.
std::optional<std::string> note_name_problem(std::string_view name);
std::optional<std::string> destination_problem(const Destination& destination);
std::optional<std::string> area_problem(const NoGoArea& area);

/// As `Notes` of web/openapi.yaml.
nlohmann::json notes_json(const Notes& notes);
/// The same with a version, for a file.
std::string notes_text(const Notes& notes);
/// Reads such a file. Throws InputError, in a few words, for anything else.
Notes notes_from(std::string_view text);

}  // namespace dynslam
