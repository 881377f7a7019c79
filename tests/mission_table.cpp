// SPDX-License-Identifier: MIT
#include "mission_table.h"

#include <algorithm>
#include <array>
#include <cstdio>

#include "sim/robot_shape.h"

namespace dynslam {
namespace {

template <class... Values>
std::string line(const char* format, Values... values) {
  std::array<char, 256> text{};
  std::snprintf(text.data(), text.size(), format, values...);
  return text.data();
}

double number(const nlohmann::json& mission, const char* key) {
  return mission.is_object() ? mission.value(key, 0.0) : 0.0;
}

/// Of the contacts, those with things that are lower than the lidar looks.
int unseen_contacts(const nlohmann::json& mission) {
  if (!mission.is_object() || !mission.contains("contact_places")) return 0;
  const nlohmann::json& places = mission["contact_places"];
  return static_cast<int>(std::count_if(places.begin(), places.end(), [](const nlohmann::json& place) {
    return place.value("high_m", kLidarHeight_m) < kLidarHeight_m;
  }));
}

}  // namespace

void MissionTable::add_exploration(const std::string& world, int seed, double yardstick_s,
                                   const nlohmann::json& mission) {
  const double time_s = number(mission, "time_s");
  explorations_.push_back(line("%-10s %4d %8.0f %8.0f %6.2f %8.2f %9.0f\n", world.c_str(), seed, time_s,
                               yardstick_s, yardstick_s > 0 ? time_s / yardstick_s : 0.0,
                               100.0 * number(mission, "reachable_floor_mapped"),
                               number(mission, "contacts")));
}

void MissionTable::add_goals(const std::string& world, int seed, int wanted, const nlohmann::json& mission) {
  const auto goals = mission.is_object() && mission.contains("goals") ? mission["goals"] : nlohmann::json();
  const int reached = static_cast<int>(number(goals, "reached"));
  const int no_route_right = static_cast<int>(number(goals, "no_route_right"));
  const int contacts = static_cast<int>(number(mission, "contacts")), unseen = unseen_contacts(mission);
  const double wait_s = number(mission, "longest_wait_s");
  goals_.push_back(
      line("%-10s %4d %6d %7d %8d %6d %8d %6d %6.1f %6.1f %7.2f %9.2f %7.2f\n", world.c_str(), seed, wanted,
           reached, no_route_right, wanted - reached - no_route_right, contacts, unseen, wait_s,
           100.0 * number(mission, "worst_m"), 100.0 * number(mission, "least_clearance_m"),
           number(mission, "reversals_driving_per_m"), number(mission, "reversals_on_spot_per_m")));
  sum_.wanted += wanted;
  sum_.right += reached + no_route_right;
  sum_.contacts += contacts;
  sum_.unseen += unseen;
  sum_.longest_wait_s = std::max(sum_.longest_wait_s, wait_s);
}

std::string MissionTable::text() const {
  std::string text;
  if (!explorations_.empty()) text += "\nexplored   seed   time s  knowing  ratio mapped %  contacts\n";
  for (const std::string& row : explorations_) text += row;
  if (goals_.empty()) return text;
  text +=
      "\nworld      seed  goals reached no route failed contacts unseen wait s off cm room cm "
      "reversals on spot\n";
  for (const std::string& row : goals_) text += row;
  text += line(
      "%d of %d goals reached or rightly not: %.1f %%; %d contacts (%d with what is too low to be seen)",
      sum_.right, sum_.wanted, 100.0 * sum_.right / std::max(1, sum_.wanted), sum_.contacts, sum_.unseen);
  return text + line("; longest wait with a free way %.1f s\n", sum_.longest_wait_s);
}

}  // namespace dynslam
