// SPDX-License-Identifier: MIT
#include "sim_mission.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "robot_config.h"

namespace dynslam {
namespace {

constexpr Duration kTurnEvery = std::chrono::milliseconds(50);
constexpr Duration kFetchTruthEvery = std::chrono::seconds(60);
constexpr double kLongest_s = 24 * 3600.0;
constexpr double kFloorStep_m = 0.1;
/// Ten scans a second, five minutes of them.
constexpr std::size_t kPathOfTheHour = 3000;

}  // namespace

SimMission::SimMission(const SimMissionOptions& options, std::unique_ptr<MissionScript> script,
                       const Config& config, const Clock& clock)
    : clock_(clock),
      begin_(clock.now()),
      limit_s_(options.limit_s.value_or(kLongest_s)),
      keeps_trajectories_(options.keeps_trajectories),
      script_(std::move(script)),
      simulator_(std::make_shared<Simulator>(options.world, clock, options.seed)),
      robot_(make_devices(simulator_), robot_config(config), clock, options.watch) {
  if (!keeps_trajectories_) robot_.slam().keep_path(kPathOfTheHour);
  robot_.on_scan([this](const ScanResult& scan) {
    ++scans_;
    if (keeps_trajectories_) result.trajectory_live.push_back({scan.stamp, scan.map_T_robot});
    result.inserted += scan.inserted ? 1 : 0;
  });
}

std::optional<MissionEnd> SimMission::turn() {
  const Time now = clock_.now();
  if (keeps_trajectories_ && now >= next_truth_) fetch_truth(now);
  if (passed_s() >= limit_s_) return MissionEnd{"timeout", "the time is up"};
  if (now < next_turn_) return std::nullopt;
  next_turn_ = now + kTurnEvery;
  driving_.note(now, robot_.ports(), *simulator_);
  return script_->turn(now, robot_.ports(), *simulator_);
}

nlohmann::json SimMission::finish(const MissionEnd& end) {
  if (keeps_trajectories_) fetch_truth(clock_.now());
  robot_.finish();
  take_result(robot_.slam(), result);
  result.counters = robot_.counters();
  if (const auto status = robot_.ports().autopilot.get().value) {
    result.route_map = status->route_map;
    for (const PlaceShown& place : status->places) result.places_map.push_back(place.point_map);
  }
  const SimTruth truth = simulator_->truth();
  const GoalCounts goals = script_->goals();
  nlohmann::json figures = {{"result", end.result},
                            {"reason", end.reason},
                            {"time_s", passed_s()},
                            {"distance_m", truth.distance_m},
                            {"contacts", truth.contacts},
                            {"kicks", truth.kicks},
                            {"reachable_floor_mapped", reachable_floor_mapped()},
                            {"goals",
                             {{"tried", goals.tried},
                              {"reached", goals.reached},
                              {"no_route_right", goals.no_route_right},
                              {"failed", goals.failed}}},
                            {"verdicts", verdicts()}};
  figures.update(driving_.figures());
  figures.update(script_->details());
  return figures;
}

std::vector<StampedPose> SimMission::truth_map() const {
  const Pose2 map_T_world = simulator_->world().world_T_start.inverse();
  std::vector<StampedPose> poses;
  for (const TruePose& p : truth_) poses.push_back({p.stamp, map_T_world * p.world_T_robot});
  return poses;
}

void SimMission::fetch_truth(Time now) {
  constexpr Duration kJustBefore = std::chrono::milliseconds(10);
  for (const TruePose& p :
       simulator_->truth_since(truth_.empty() ? begin_ - kJustBefore : truth_.back().stamp))
    truth_.push_back(p);
  next_truth_ = now + kFetchTruthEvery;
}

/// The share of the floor that the robot could have driven over, and that its map shows as free.
double SimMission::reachable_floor_mapped() {
  const std::vector<Vector2> floor = simulator_->reachable_floor(kFloorStep_m);
  if (floor.empty()) return 0.0;
  const Pose2 map_T_world = simulator_->world().world_T_start.inverse();
  const auto is_free = [&](const Vector2& p) {
    return result.map.state(cell_at(map_T_world * p, result.map.cell_size_m())) == CellState::kFree;
  };
  return static_cast<double>(std::count_if(floor.begin(), floor.end(), is_free)) /
         static_cast<double>(floor.size());
}

nlohmann::json SimMission::verdicts() const {
  nlohmann::json all = nlohmann::json::array();
  for (const DriveControl::Transition& t : robot_.control().transitions())
    all.push_back({{"time_s", to_seconds(t.time - begin_)},
                   {"motion", to_string(t.verdict.motion)},
                   {"reason", t.verdict.reason}});
  return all;
}

}  // namespace dynslam
