// SPDX-License-Identifier: MIT
#include "tour_script.h"

namespace dynslam {
namespace {

/// As seen from the robot's start, lap after lap.
std::vector<Vector2> points_map(const World& world, int laps) {
  std::vector<Vector2> points;
  for (int lap = 0; lap < laps; ++lap) {
    for (const Vector2& p : world.tour) points.push_back(world.world_T_start.inverse() * p);
  }
  return points;
}

std::string skipped_text(std::size_t skipped) {
  if (skipped == 0) return "all points reached";
  return std::to_string(skipped) + (skipped == 1 ? " point" : " points") + " could not be reached";
}

}  // namespace

TourScript::TourScript(const World& world, int laps) : tour_(points_map(world, laps)) {}

std::optional<MissionEnd> TourScript::turn(Time now, Ports& ports, Simulator&) {
  if (tour_.done()) return MissionEnd{"done", skipped_text(tour_.skipped())};
  if (tour_.gave_up()) return MissionEnd{"stopped", *tour_.gave_up()};
  if (somebody_drives_()) return std::nullopt;
  const auto world = ports.world.get().value;
  const auto drive = ports.drive.get().value;
  const Twist twist = world && drive ? tour_.next(now, world->pose, drive->verdict) : Twist{};
  ports.command.put({++seq_, twist, now});
  return std::nullopt;
}

GoalCounts TourScript::goals() const {
  // Nothing is said of routes: a tour is driven without.
  return {tour_.reached() + tour_.skipped(), tour_.reached(), 0, tour_.skipped()};
}

}  // namespace dynslam
