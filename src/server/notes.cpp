// SPDX-License-Identifier: MIT
#include "server/notes.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/utf8_text.h"

namespace dynslam {
namespace {

using nlohmann::json;

constexpr int kVersion = 1;

bool is_near(const Vector2& point) {
  return std::abs(point.x()) <= kFarthestNote_m && std::abs(point.y()) <= kFarthestNote_m;
}

json destination_json(const Destination& d) {
  json out = {{"x_m", d.point_map.x()}, {"y_m", d.point_map.y()}};
  if (d.yaw_rad) out["yaw_rad"] = *d.yaw_rad;
  if (!d.name.empty()) out["name"] = d.name;
  return out;
}

json area_json(const NoGoArea& area) {
  json corners = json::array();
  for (const Vector2& c : area.corners_map) corners.push_back({c.x(), c.y()});
  return {{"name", area.name}, {"corners", corners}};
}

void require(const std::optional<std::string>& problem) {
  if (problem) throw InputError(*problem);
}

Destination destination_from(const json& from, bool has_name) {
  Destination d;
  d.point_map = {from.at("x_m").get<double>(), from.at("y_m").get<double>()};
  if (from.contains("yaw_rad")) d.yaw_rad = from.at("yaw_rad").get<double>();
  if (has_name || from.contains("name")) d.name = from.at("name").get<std::string>();
  if (has_name || !d.name.empty()) require(note_name_problem(d.name));
  require(destination_problem(d));
  return d;
}

NoGoArea area_from(const json& from) {
  NoGoArea area{from.at("name").get<std::string>(), {}};
  for (const json& c : from.at("corners").get_ref<const json::array_t&>())
    area.corners_map.emplace_back(c.at(0).get<double>(), c.at(1).get<double>());
  require(note_name_problem(area.name));
  require(area_problem(area));
  return area;
}

/// An id becomes the name of a file.
bool is_map_id(std::string_view text) {
  return !text.empty() && text.size() <= kLongestNoteName &&
         std::all_of(text.begin(), text.end(),
                     [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || c == '-'; });
}

template <class Named>
bool has_twins(const std::vector<Named>& all) {
  return std::adjacent_find(all.begin(), all.end(),
                            [](const auto& a, const auto& b) { return a.name >= b.name; }) != all.end();
}

Notes checked(const json& from) {
  if (from.at("version") != kVersion) throw InputError("a version that this program does not know");
  Notes notes{from.at("map_id").get<std::string>(), from.at("notice").get<std::string>()};
  if (!is_map_id(notes.map_id)) throw InputError("no map's id");
  if (!from.at("home").is_null()) notes.home = destination_from(from.at("home"), false);
  for (const json& place : from.at("places").get_ref<const json::array_t&>())
    notes.places.push_back(destination_from(place, true));
  for (const json& area : from.at("areas").get_ref<const json::array_t&>())
    notes.areas.push_back(area_from(area));
  if (notes.places.size() > kMostPlaces || notes.areas.size() > kMostAreas) throw InputError("too much");
  if (has_twins(notes.places) || has_twins(notes.areas)) throw InputError("names that are not in order");
  return notes;
}

}  // namespace

MapNotes Notes::for_robot() const {
  MapNotes told{{}, home};
  for (const NoGoArea& area : areas) told.forbidden_map.push_back(area.corners_map);
  return told;
}

std::optional<std::string> note_name_problem(std::string_view name) {
  const auto characters = plain_characters(name);
  if (!characters || *characters == 0 || *characters > kLongestNoteName)
    return "a name has 1 to 40 characters, none of them a control character";
  if (name.front() == '.' || name.find_first_of("/\\") != std::string_view::npos)
    return "a name does not begin with a dot and has no slash in it";
  if (name.front() == ' ' || name.back() == ' ') return "a name does not begin or end with a space";
  return std::nullopt;
}

std::optional<std::string> destination_problem(const Destination& d) {
  if (!is_near(d.point_map)) return "a point is at most 1000 m from the map's origin, along each axis";
  if (d.yaw_rad && !std::isfinite(*d.yaw_rad)) return "a direction must be finite";
  return std::nullopt;
}

std::optional<std::string> area_problem(const NoGoArea& area) {
  if (area.corners_map.size() < kLeastCorners || area.corners_map.size() > kMostCorners)
    return "an area has 3 to 64 corners";
  if (!std::all_of(area.corners_map.begin(), area.corners_map.end(), is_near))
    return "a corner is at most 1000 m from the map's origin, along each axis";
  return std::nullopt;
}

json notes_json(const Notes& notes) {
  json places = json::array(), areas = json::array();
  for (const Destination& place : notes.places) places.push_back(destination_json(place));
  for (const NoGoArea& area : notes.areas) areas.push_back(area_json(area));
  return {{"map_id", notes.map_id},
          {"notice", notes.notice},
          {"home", notes.home ? destination_json(*notes.home) : json(nullptr)},
          {"places", places},
          {"areas", areas}};
}

std::string notes_text(const Notes& notes) {
  json all = notes_json(notes);
  all["version"] = kVersion;
  return all.dump(1, ' ', false, json::error_handler_t::replace) + '\n';
}

Notes notes_from(std::string_view text) {
  try {
    return checked(json::parse(text));
  } catch (const json::parse_error&) {
    throw InputError("no whole JSON");
  } catch (const json::exception&) {
    throw InputError("something missing or of the wrong type");
  }
}

}  // namespace dynslam
