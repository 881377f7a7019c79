// SPDX-License-Identifier: MIT
// Simulated robots that drive lap after lap, step by step, as fast as it goes: whether memory grows with the
// hours. Prints what is allocated each minute; exits with 1 when it was more at the end than halfway. What
// one drive holds goes up and down by a tenth with how many local maps it takes to know the place: of several
// drives it is the median that tells, as a leak shows in each of them.
//
//   build/release/tests/tools/soak/dynslam_soak [--minutes 30] [--drives 1] [--world apartment]
//   [--most-growth 5]
#include <algorithm>
#include <cstdio>
#include <exception>
#include <string>

#include <CLI/CLI.hpp>
#include <malloc.h>

#include "config.h"
#include "robot/robot.h"
#include "robot/tour.h"
#include "sim/simulator.h"

#ifdef __SANITIZE_ADDRESS__
// Of the sanitizer's allocator_interface.h, which GCC does not install.
extern "C" std::size_t __sanitizer_get_current_allocated_bytes();  // NOLINT
#endif

namespace dynslam::soak {
namespace {

constexpr Duration kStep = std::chrono::milliseconds(10);
constexpr Duration kCommandEvery = std::chrono::milliseconds(50);
constexpr std::size_t kPath = 3000;

/// What is allocated and not given back.
double in_use_mb() {
#ifdef __SANITIZE_ADDRESS__
  return static_cast<double>(__sanitizer_get_current_allocated_bytes()) / 1e6;
#else
  const struct mallinfo2 info = mallinfo2();
  return static_cast<double>(info.uordblks + info.hblkhd) / 1e6;
#endif
}

/// Laps round the world, without end.
class Soak {
 public:
  Soak(const World& world, std::uint64_t seed)
      : simulator_(std::make_shared<Simulator>(world, clock_, seed)),
        robot_(make_devices(simulator_), {}, clock_) {
    for (const Vector2& p : world.tour) points_.push_back(world.world_T_start.inverse() * p);
    robot_.slam().keep_path(kPath);
  }

  void go_on(Duration length) {
    const Time end = clock_.now() + length;
    while (clock_.now() < end) {
      clock_.set(clock_.now() + kStep);
      if (clock_.now() >= next_command_) command();
      robot_.step();
    }
  }
  int laps() const { return laps_; }
  SimTruth truth() { return simulator_->truth(); }
  Slam& slam() { return robot_.slam(); }

 private:
  void command() {
    next_command_ = clock_.now() + kCommandEvery;
    if (tour_.done() || tour_.gave_up()) {
      tour_ = Tour(points_);
      ++laps_;
    }
    const auto world = robot_.ports().world.get().value;
    const auto drive = robot_.ports().drive.get().value;
    const Twist twist = world && drive ? tour_.next(clock_.now(), world->pose, drive->verdict) : Twist{};
    robot_.ports().command.put({++seq_, twist, clock_.now()});
  }

  SteppedClock clock_;
  std::shared_ptr<Simulator> simulator_;
  Robot robot_;
  std::vector<Vector2> points_;
  Tour tour_{{}};
  Time next_command_;
  std::uint64_t seq_ = 0;
  int laps_ = 0;
};

/// One robot's drive, told minute by minute. How much more was in use at its end than halfway, in percent.
double growth_of_drive(const World& world, std::uint64_t seed, int minutes) {
  Soak soak(world, seed);
  std::printf("drive %llu\nminute   laps   way m contacts    maps  active   in use MB\n",
              static_cast<unsigned long long>(seed));
  double halfway_mb = 0.0, end_mb = 0.0;
  for (int minute = 1; minute <= minutes; ++minute) {
    soak.go_on(std::chrono::minutes(1));
    const double mb = in_use_mb();
    // The most of a few minutes: what is under way comes and goes.
    if (minute > minutes / 3 && minute <= minutes / 2 + 1) halfway_mb = std::max(halfway_mb, mb);
    if (minute > minutes * 5 / 6) end_mb = std::max(end_mb, mb);
    const SimTruth truth = soak.truth();
    std::printf("%6d %6d %7.0f %8d %7zu %7zu %11.2f\n", minute, soak.laps(), truth.distance_m, truth.contacts,
                soak.slam().local_maps_begun(), soak.slam().local_maps_active(), mb);
    std::fflush(stdout);
  }
  return 100.0 * (end_mb / halfway_mb - 1.0);
}

int run(int argc, char** argv) {
  CLI::App app("dynslam_soak: whether a robot that drives for long needs more memory");
  int minutes = 30;
  int drives = 1;
  std::string name = "apartment";
  double most_growth = 5.0;
  app.add_option("--minutes", minutes, "of simulated time, each drive")->check(CLI::Range(2, 100000));
  app.add_option("--drives", drives, "one after the other, with seeds from 1 on")->check(CLI::Range(1, 1000));
  app.add_option("--world", name, "name or file");
  app.add_option("--most-growth", most_growth,
                 "in percent, from halfway to the end: the median of the drives");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 2;
  }
  const World world = load_world(name);
  std::vector<double> growths;
  for (int drive = 1; drive <= drives; ++drive) {
    growths.push_back(growth_of_drive(world, static_cast<std::uint64_t>(drive), minutes));
    std::printf("from halfway to the end: %+.1f %%\n", growths.back());
  }
  std::nth_element(growths.begin(), growths.begin() + drives / 2, growths.end());
  const double median = growths[static_cast<std::size_t>(drives / 2)];
  std::printf("median of %d: %+.1f %%, %.1f at the most\n", drives, median, most_growth);
  return median <= most_growth ? 0 : 1;
}

}  // namespace
}  // namespace dynslam::soak

int main(int argc, char** argv) {
  try {
    return dynslam::soak::run(argc, argv);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "dynslam_soak: %s\n", e.what());
    return 2;
  }
}
