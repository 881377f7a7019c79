// SPDX-License-Identifier: MIT
#include "tour_mission.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "robot_config.h"

namespace dynslam {
namespace {

constexpr Duration kCommandEvery = std::chrono::milliseconds(50);
constexpr Duration kFetchTruthEvery = std::chrono::seconds(60);
constexpr double kLongest_s = 24 * 3600.0;
constexpr double kFloorStep_m = 0.1;
/// Ten scans a second, five minutes of them.
constexpr std::size_t kPathOfTheHour = 3000;

/// As seen from the robot's start, lap after lap.
std::vector<Vector2> points_map(const World& world, int laps) {
  std::vector<Vector2> points;
  for (int lap = 0; lap < laps; ++lap) {
    for (const Vector2& p : world.tour) points.push_back(world.world_T_start.inverse() * p);
  }
  return points;
}

}  // namespace

TourMission::TourMission(const TourMissionOptions& options, const Config& config, const Clock& clock)
    : clock_(clock),
      begin_(clock.now()),
      limit_s_(options.limit_s.value_or(kLongest_s)),
      keeps_trajectories_(options.keeps_trajectories),
      waits_(options.waits),
      simulator_(std::make_shared<Simulator>(options.world, clock, options.seed)),
      robot_(make_devices(simulator_), robot_config(config), clock),
      tour_(points_map(options.world, options.laps)) {
  if (!keeps_trajectories_) robot_.slam().keep_path(kPathOfTheHour);
  robot_.on_scan([this](const ScanResult& scan) {
    ++scans_;
    if (keeps_trajectories_) result.trajectory_live.push_back({scan.stamp, scan.map_T_robot});
    result.inserted += scan.inserted ? 1 : 0;
  });
}

std::optional<MissionEnd> TourMission::turn() {
  const Time now = clock_.now();
  if (keeps_trajectories_ && now >= next_truth_) fetch_truth(now);
  if (passed_s() >= limit_s_) return MissionEnd{"timeout", "the time is up"};
  if (tour_.done() && !waits_) return MissionEnd{"done", skipped_text()};
  if (tour_.gave_up()) return MissionEnd{"stopped", *tour_.gave_up()};
  if (now < next_command_) return std::nullopt;
  next_command_ = now + kCommandEvery;
  if (waits_ || somebody_drives_()) return std::nullopt;
  const auto world = robot_.ports().world.get().value;
  const auto drive = robot_.ports().drive.get().value;
  const Twist twist = world && drive ? tour_.next(now, world->pose, drive->verdict) : Twist{};
  robot_.ports().command.put({++seq_, twist, now});
  return std::nullopt;
}

nlohmann::json TourMission::finish(const MissionEnd& end) {
  if (keeps_trajectories_) fetch_truth(clock_.now());
  robot_.finish();
  take_result(robot_.slam(), result);
  result.counters = robot_.counters();
  const SimTruth truth = simulator_->truth();
  return {{"result", end.result},
          {"reason", end.reason},
          {"time_s", passed_s()},
          {"distance_m", truth.distance_m},
          {"contacts", truth.contacts},
          {"kicks", truth.kicks},
          {"reachable_floor_mapped", reachable_floor_mapped()},
          {"goals",
           {{"tried", tour_.reached() + tour_.skipped()},
            {"reached", tour_.reached()},
            {"no_route_right", 0},  // a tour is driven without routes
            {"failed", tour_.skipped()}}},
          {"verdicts", verdicts()}};
}

std::vector<StampedPose> TourMission::truth_map() const {
  const Pose2 map_T_world = simulator_->world().world_T_start.inverse();
  std::vector<StampedPose> poses;
  for (const TruePose& p : truth_) poses.push_back({p.stamp, map_T_world * p.world_T_robot});
  return poses;
}

void TourMission::fetch_truth(Time now) {
  constexpr Duration kJustBefore = std::chrono::milliseconds(10);
  for (const TruePose& p :
       simulator_->truth_since(truth_.empty() ? begin_ - kJustBefore : truth_.back().stamp))
    truth_.push_back(p);
  next_truth_ = now + kFetchTruthEvery;
}

std::string TourMission::skipped_text() const {
  if (tour_.skipped() == 0) return "all points reached";
  return std::to_string(tour_.skipped()) + (tour_.skipped() == 1 ? " point" : " points") +
         " could not be reached";
}

/// The share of the floor that the robot could have driven over, and that its map shows as free.
double TourMission::reachable_floor_mapped() {
  const std::vector<Vector2> floor = simulator_->reachable_floor(kFloorStep_m);
  if (floor.empty()) return 0.0;
  const Pose2 map_T_world = simulator_->world().world_T_start.inverse();
  const auto is_free = [&](const Vector2& p) {
    return result.map.state(cell_at(map_T_world * p, result.map.cell_size_m())) == CellState::kFree;
  };
  return static_cast<double>(std::count_if(floor.begin(), floor.end(), is_free)) /
         static_cast<double>(floor.size());
}

nlohmann::json TourMission::verdicts() const {
  nlohmann::json all = nlohmann::json::array();
  for (const DriveControl::Transition& t : robot_.control().transitions())
    all.push_back({{"time_s", to_seconds(t.time - begin_)},
                   {"motion", to_string(t.verdict.motion)},
                   {"reason", t.verdict.reason}});
  return all;
}

}  // namespace dynslam
