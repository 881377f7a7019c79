// SPDX-License-Identifier: MIT
#include "drive_record.h"

#include <algorithm>
#include <cmath>

#include "goal_rules.h"

namespace dynslam {
namespace {

constexpr double kFelt_radps = 0.15;  ///< slower turns go unnoticed
constexpr double kOnSpot_mps = 0.02;  ///< who turns and drives slower than this turns on the spot
constexpr double kMoved_m = 0.05;     ///< less may be the pose's noise
constexpr double kStays_m = 0.1;      ///< who fidgets within this waits too
/// Whether there is a way is looked at so often, while it stays.
constexpr Duration kCheckEvery = std::chrono::seconds(2);

bool has_way_to(const Vector2& goal_map, Simulator& simulator) {
  const Vector2 goal = simulator.world().world_T_start * goal_map;
  const std::vector<Vector2> floor = simulator.reachable_floor(kFloorStep_m);
  return std::any_of(floor.begin(), floor.end(),
                     [&](const Vector2& p) { return (p - goal).norm() < kNearby_m; });
}

}  // namespace

void DriveRecord::note(Time now, const Ports& ports, Simulator& simulator) {
  if (!begin_) begin_ = now;
  now_s_ = to_seconds(now - *begin_);
  truth_map_ = simulator.world().world_T_start.inverse() * simulator.truth().world_T_robot;
  note_contacts(simulator);
  const auto status = ports.autopilot.get().value;
  const auto drive = ports.drive.get().value;
  const auto world = ports.world.get().value;
  if (!status || status->phase != AutopilotPhase::kActive || !drive || !world) {
    anchor_.reset();
    pose_.reset();
    return;
  }
  note_wait(now, *status, simulator);
  note_turns(drive->applied);
  if (is_moving(drive->applied)) note_room(simulator);
  const Pose2& pose = world->pose.map_T_robot;
  if (!pose_) pose_ = pose;
  const double moved_m = (pose.translation() - pose_->translation()).norm();
  if (moved_m < kMoved_m) return;
  way_m_ += moved_m;
  pose_ = pose;
}

void DriveRecord::note_wait(Time now, const AutopilotStatus& status, Simulator& simulator) {
  if (!status.goal || !anchor_ || (truth_map_.translation() - anchor_->translation()).norm() > kStays_m) {
    anchor_ = truth_map_;
    free_since_ = free_checked_ = now;
    return;
  }
  if (now - free_checked_ >= kCheckEvery) {
    free_checked_ = now;
    if (!has_way_to(status.goal->point_map, simulator)) free_since_ = now;
  }
  const double waited_s = to_seconds(free_checked_ - free_since_);
  if (waited_s > longest_wait_.value) longest_wait_ = here(waited_s);
}

void DriveRecord::note_turns(const Twist& twist) {
  if (std::abs(twist.w_radps) < kFelt_radps) return;
  const bool on_spot = std::abs(twist.v_mps) < kOnSpot_mps || std::abs(last_turn_.v_mps) < kOnSpot_mps;
  if (twist.w_radps * last_turn_.w_radps < 0.0) ++(on_spot ? reversals_on_spot_ : reversals_driving_);
  last_turn_ = twist;
}

void DriveRecord::note_room(Simulator& simulator) {
  const Room room = simulator.room();
  if (room.to_things_m < least_to_things_.value) least_to_things_ = here(room.to_things_m);
  if (room.to_people_m < least_to_people_.value) least_to_people_ = here(room.to_people_m);
}

void DriveRecord::note_contacts(Simulator& simulator) {
  const int contacts = simulator.truth().contacts;
  if (contacts == contacts_) return;
  contacts_ = contacts;
  nlohmann::json contact = place(here(contacts));
  if (const auto touched = simulator.touched()) contact["high_m"] = touched->high_m;
  contact_places_.push_back(contact);
}

nlohmann::json DriveRecord::place(const Worst& worst) {
  return {{"time_s", worst.time_s},
          {"x_m", worst.map_T_robot.x},
          {"y_m", worst.map_T_robot.y},
          {"yaw_rad", worst.map_T_robot.yaw}};
}

nlohmann::json DriveRecord::figures() const {
  return {{"longest_wait_s", longest_wait_.value},
          {"longest_wait_at", place(longest_wait_)},
          {"reversals_per_m", per_m(reversals_driving_ + reversals_on_spot_)},
          {"reversals_driving_per_m", per_m(reversals_driving_)},
          {"reversals_on_spot_per_m", per_m(reversals_on_spot_)},
          {"least_clearance_m", least_to_things_.value},
          {"least_clearance_at", place(least_to_things_)},
          {"least_clearance_to_people_m", least_to_people_.value},
          {"least_clearance_to_people_at", place(least_to_people_)},
          {"contact_places", contact_places_}};
}

}  // namespace dynslam
