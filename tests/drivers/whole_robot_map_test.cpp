// SPDX-License-Identifier: MIT
// The whole daemon on its real drivers maps a flat in real time, and as well as on the simulator's devices.
#include <algorithm>
#include <cmath>
#include <iostream>

#include "drivers/whole_robot.h"
#include "robot/mapping_result.h"
#include "robot/tour.h"
#include "robot_config.h"
#include "sim/simulator.h"
#include "tools/jitter/trajectory_error.h"

namespace dynslam::test {
namespace {

using std::chrono::milliseconds;

constexpr double kFloorStep_m = 0.1;
constexpr double kOnWall_m = 0.05;
constexpr double kLongest_s = 400.0;

/// A flat in which nobody walks: who stands in the way when is not the same in real time.
World quiet_flat() {
  World world = load_world("apartment");
  world.people.clear();
  return world;
}

/// Down the living room, through the kitchen and back along the hall: the way closes.
std::vector<Vector2> round_map(const World& world) {
  std::vector<Vector2> points;
  for (std::size_t i = 9; i < 20; ++i) points.push_back(world.world_T_start.inverse() * world.tour.at(i));
  points.push_back(Vector2::Zero());
  return points;
}

double distance_m(const Vector2& p, const Surface& s) {
  if (s.radius_m > 0.0) return std::abs((p - s.from).norm() - s.radius_m);
  const double along = std::clamp((p - s.from).dot(s.along) / s.along.squaredNorm(), 0.0, 1.0);
  return (p - s.from - along * s.along).norm();
}

/// How good a map is by what is true.
struct Quality {
  double path_off_m = 0.0;     ///< root of the mean square
  double walls_right = 0.0;    ///< share of the occupied cells that lie on what is there
  double floor_mapped = 0.0;   ///< share of the reachable floor that is free
  std::uint64_t closures = 0;  ///< of loops
};
std::ostream& operator<<(std::ostream& out, const Quality& q) {
  return out << "path off by " << 1000.0 * q.path_off_m << " mm, " << 100.0 * q.walls_right
             << " % of the walls right, " << 100.0 * q.floor_mapped << " % of the floor, " << q.closures
             << " loops closed";
}

class Judge {
 public:
  explicit Judge(const World& world) : world_(world), caster_(fixed_surfaces(world), {}) {
    SteppedClock clock;
    floor_ = Simulator(world, clock).reachable_floor(kFloorStep_m);
  }

  Quality judge(Slam& slam, const std::vector<StampedPose>& truth_map) const {
    MappingResult result;
    take_result(slam, result);
    Quality quality;
    quality.path_off_m = jitter::absolute_error_m(result.trajectory, truth_map);
    quality.walls_right = walls_right(trinary_map(result.map));
    const Pose2 map_T_world = world_.world_T_start.inverse();
    const auto mapped = std::count_if(floor_.begin(), floor_.end(), [&](const Vector2& p) {
      return result.map.state(cell_at(map_T_world * p, result.map.cell_size_m())) == CellState::kFree;
    });
    quality.floor_mapped = static_cast<double>(mapped) / static_cast<double>(floor_.size());
    quality.closures = result.loop_closures;
    return quality;
  }

 private:
  double walls_right(const TrinaryMap& map) const {
    int occupied = 0, right = 0;
    for (int row = 0; row < map.height; ++row) {
      for (int column = 0; column < map.width; ++column) {
        if (map.at(column, row) != CellState::kOccupied) continue;
        const Vector2 p_map =
            map.cell_size_m * Vector2(map.origin.x + column + 0.5, map.origin.y + row + 0.5);
        const Vector2 p = world_.world_T_start * p_map;
        ++occupied;
        right +=
            caster_.any_near(p, kOnWall_m, [&](const Surface& s) { return distance_m(p, s) < kOnWall_m; });
      }
    }
    return occupied > 0 ? static_cast<double>(right) / occupied : 0.0;
  }

  World world_;
  RayCaster caster_;
  std::vector<Vector2> floor_;
};

/// The same way on the simulator's own devices, step by step.
Quality on_simulated_devices(const World& world, const Config& config, const Judge& judge) {
  SteppedClock clock;
  const auto simulator = std::make_shared<Simulator>(world, clock);
  Robot robot(make_devices(simulator), robot_config(config), clock);
  Tour tour(round_map(world));
  std::uint64_t seq = 0;
  Time next_command;
  while (!tour.done() && !tour.gave_up() && clock.now() < Time() + from_seconds(kLongest_s)) {
    clock.set(clock.now() + milliseconds(10));
    robot.step();
    const auto pose = robot.ports().world.get().value;
    if (clock.now() < next_command || !pose) continue;
    next_command = clock.now() + milliseconds(50);
    const Verdict verdict = robot.ports().drive.get().value->verdict;
    robot.ports().command.put({++seq, tour.next(clock.now(), pose->pose, verdict), clock.now()});
  }
  robot.finish();
  std::vector<StampedPose> truth_map;
  for (const TruePose& p : simulator->truth_since(Time() - milliseconds(1)))
    truth_map.push_back({p.stamp, world.world_T_start.inverse() * p.world_T_robot});
  std::cout << "simulated devices: " << to_seconds(clock.now() - Time()) << " s, ";
  EXPECT_TRUE(tour.done());
  return judge.judge(robot.slam(), truth_map);
}

/// Notes when an IMU spoke, for how even its grid is.
class NotedImu : public Imu {
 public:
  NotedImu(std::unique_ptr<Imu> imu, std::vector<Time>& stamps) : imu_(std::move(imu)), stamps_(stamps) {}
  std::optional<ImuSample> next(Time until) override {
    auto sample = imu_->next(until);
    if (sample) stamps_.push_back(sample->stamp);
    return sample;
  }

 private:
  std::unique_ptr<Imu> imu_;
  std::vector<Time>& stamps_;
};

/// Off the grid from one sample to the next, in ms, which so many in a hundred keep below.
double off_grid_ms(const std::vector<Time>& stamps, int percent) {
  constexpr double kPeriod_ms = 20.0;
  std::vector<double> off;
  for (std::size_t i = 1; i < stamps.size(); ++i)
    off.push_back(std::abs(std::remainder(1000.0 * to_seconds(stamps[i] - stamps[i - 1]), kPeriod_ms)));
  if (off.empty()) return 0.0;
  std::sort(off.begin(), off.end());
  return off[(off.size() - 1) * static_cast<std::size_t>(percent) / 100];
}

TEST_F(WholeRobot, MapsAFlatAsWellAsOnSimulatedDevices) {
  const World world = quiet_flat();
  const Judge judge(world);
  const Quality simulated = on_simulated_devices(world, {}, judge);
  std::cout << simulated << "\n";

  begin(world);
  std::vector<Time> imu_stamps;
  start([&](Devices& devices) {
    devices.imu = std::make_unique<NotedImu>(std::move(devices.imu), imu_stamps);
  });
  Tour tour(round_map(world));
  std::atomic<bool> over{false};
  drive_by([&](Time when, const PoseEstimate& pose, const Verdict& verdict) {
    hardware().motors.set_battery_v(hardware().world.battery_v());
    const Twist twist = tour.next(when, pose, verdict);
    over = tour.done() || tour.gave_up();
    return twist;
  });
  const auto took_s = comes_true(kLongest_s, [&] { return over.load(); });
  let_go();
  EXPECT_TRUE(took_s && tour.done()) << tour.gave_up().value_or("out of time") << "\n" << state();
  EXPECT_EQ(robot().stop().trouble, "");
  robot().finish();
  const Quality real = judge.judge(robot().slam(), hardware().world.truth_map());
  std::cout << "real drivers: " << took_s.value_or(kLongest_s) << " s, " << real << "\n";
  std::cout << "IMU off its grid: median " << off_grid_ms(imu_stamps, 50) << " ms, 99 % below "
            << off_grid_ms(imu_stamps, 99) << " ms, of " << imu_stamps.size() << "\n";
  for (const auto& [name, n] : robot().counters()) std::cout << "  " << name << ": " << n << "\n";
  EXPECT_EQ(hardware().world.contacts(), 0);
  EXPECT_EQ(trouble("lidar") + trouble("imu") + trouble("motors") + trouble("pins"), "");
  // A cell of the map more: scans come in other places, and a busy computer loses some.
  EXPECT_LT(real.path_off_m, simulated.path_off_m + 0.02);
  EXPECT_GT(real.walls_right, simulated.walls_right - 0.03);
  EXPECT_GT(real.floor_mapped, simulated.floor_mapped - 0.03);
}

}  // namespace
}  // namespace dynslam::test
