// SPDX-License-Identifier: MIT
// Random inputs of every kind, among them every kind of lie: whatever comes, no motor moves while a stop
// stands, and what a stop is is told here independently of Safety.
#include <algorithm>
#include <limits>
#include <random>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "drive/drive_control.h"
#include "drive/good_inputs.h"

namespace dynslam {
namespace {

using std::chrono::milliseconds;

class Weather {
 public:
  explicit Weather(unsigned seed) : random_(seed) {}

  bool chance(double p) { return std::bernoulli_distribution(p)(random_); }
  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }

  /// A number that may be any nonsense.
  double number(double usual) {
    static const double kLies[] = {0.0,
                                   -usual,
                                   1e300,
                                   -1e300,
                                   std::numeric_limits<double>::infinity(),
                                   -std::numeric_limits<double>::infinity(),
                                   std::numeric_limits<double>::quiet_NaN(),
                                   std::numeric_limits<double>::denorm_min()};
    if (!chance(0.02)) return usual;
    return kLies[std::uniform_int_distribution<std::size_t>(0, std::size(kLies) - 1)(random_)];
  }
  /// A stamp, mostly of now.
  Time stamp(Time now) {
    if (chance(0.97)) return now;
    return now + from_seconds(between(-3.0, 3.0));
  }

 private:
  std::mt19937 random_;
};

/// A mode that lasts for a while: devices do not lie for one tick only.
struct Mood {
  bool driver = true, lidar = true, imu = true, motors = true, pins = true;
};

struct Tally {
  int moved = 0, stopped = 0;
  std::set<std::string> kinds;
};

class Voyage {
 public:
  explicit Voyage(unsigned seed) : weather_(seed) {}

  void tick(Tally& tally) {
    advance();
    change_moods();
    make_inputs();
    const DriveOutput out = control_.step(now_, in_);
    check(out);
    tally.moved += out.power != WheelPower{} ? 1 : 0;
    tally.stopped += out.verdict.motion >= Motion::kStop ? 1 : 0;
    tally.kinds.insert(to_string(out.verdict.motion));
  }

 private:
  void advance() {
    before_ = now_;
    Duration step = milliseconds(20);
    if (weather_.chance(0.01)) step = from_seconds(weather_.between(0.0, 0.5));
    if (weather_.chance(0.002)) step = from_seconds(weather_.between(-2.0, 0.0));
    now_ += step;
  }
  void change_moods() {
    for (bool* good : {&mood_.driver, &mood_.lidar, &mood_.imu, &mood_.motors, &mood_.pins}) {
      if (weather_.chance(*good ? 0.002 : 0.05)) *good = !*good;
    }
    if (weather_.chance(0.05)) stick_ = {};
    if (weather_.chance(0.02)) stick_ = {weather_.between(-2, 2), weather_.between(-3, 3)};
    if (weather_.chance(0.05)) wall_ = weather_.chance(0.5) ? weather_.between(-1.5, 1.5) : 9.0;
  }
  void make_inputs() {
    if (mood_.driver && weather_.chance(0.5)) {
      const std::uint64_t seq = weather_.chance(0.01) ? seq_ / 2 : ++seq_;
      in_.command = DriveCommand{
          seq, {weather_.number(stick_.v_mps), weather_.number(stick_.w_radps)}, weather_.stamp(now_)};
    }
    if (mood_.lidar && weather_.chance(0.2)) in_.scan = scan();
    if (mood_.imu) {
      in_.imu = robot_.imu(weather_.stamp(now_));
      in_.imu->world_q_robot.w() = weather_.number(in_.imu->world_q_robot.w());
    }
    in_.motors = {weather_.stamp(now_), {weather_.number(12.4), !mood_.motors, false, true}};
    if (weather_.chance(0.001)) in_.motors->value.failsafe_on = false;
    in_.pins = {weather_.stamp(now_), {!mood_.pins && weather_.chance(0.1)}};
    in_.stop_asked.reset();
    if (weather_.chance(0.001)) in_.stop_asked = "somebody";
    in_.clear_asked = weather_.chance(0.05);
    in_.power_limit = weather_.number(1.0);
  }
  std::shared_ptr<const Scan> scan() {
    auto scan = std::make_shared<Scan>(scan_of(wall_at(wall_), weather_.stamp(now_), 120));
    for (Beam& b : scan->beams) {
      b.range_m =
          static_cast<float>(std::clamp(weather_.number(b.range_m + weather_.between(0, 1e-3)), -1e30, 1e30));
      if (weather_.chance(0.01)) b.angle_rad = std::numeric_limits<float>::quiet_NaN();
      if (weather_.chance(0.01)) b.time_s = 1e9F;
    }
    return scan;
  }

  void check(const DriveOutput& out) {
    const bool moves = out.power != WheelPower{};
    ASSERT_TRUE(std::abs(out.power.left) <= 0.95 && std::abs(out.power.right) <= 0.95);
    ASSERT_TRUE(is_finite(out.applied));
    ASSERT_EQ(out.verdict.reason.empty(), out.verdict.motion == Motion::kGo);
    ASSERT_FALSE(moves && out.verdict.motion >= Motion::kHold) << out.verdict.reason;
    // By the inputs alone, whatever the verdict says. A person may have cleared the stop, or tried to.
    const bool stop = in_.pins->value.estop_pressed || in_.stop_asked;
    latched_ = stop || (latched_ && !in_.clear_asked);
    ASSERT_TRUE(!latched_ || out.verdict.motion == Motion::kEStop) << out.verdict.reason;
    ASSERT_FALSE(moves && in_.pins->value.estop_pressed);
    ASSERT_FALSE(moves && now_ < before_) << "the clock ran backwards";
    ASSERT_FALSE(!heard_lately() && moves);
    ASSERT_FALSE(moves && !in_.scan);
  }
  /// Some command of the last 200 ms was given; the newest one may be refused.
  bool heard_lately() {
    if (in_.command && in_.command->heard <= now_)
      newest_heard_ = std::max(newest_heard_, in_.command->heard);
    if (now_ < before_) newest_heard_ = std::min(newest_heard_, now_);
    return now_ - newest_heard_ < milliseconds(200);
  }

  Weather weather_;
  HealthyRobot robot_;
  DriveControl control_;
  DriveInputs in_;
  Mood mood_;
  Twist stick_;
  double wall_ = 9.0;
  std::uint64_t seq_ = 0;
  bool latched_ = false;
  Time now_ = Time(std::chrono::seconds(1000)), before_ = now_, newest_heard_;
};

TEST(DriveWeather, NoSequenceOfInputsMovesAMotorWhileAStopStands) {
  Tally tally;
  for (unsigned seed = 0; seed < 40; ++seed) {
    Voyage voyage(seed);
    for (int i = 0; i < 3000; ++i) {
      voyage.tick(tally);
      if (testing::Test::HasFatalFailure()) FAIL() << "seed " << seed << ", tick " << i;
    }
  }
  EXPECT_GT(tally.moved, 2000) << "the weather was too bad to tell";
  EXPECT_GT(tally.stopped, 2000);
  EXPECT_EQ(tally.kinds.size(), 5U) << "all kinds of verdicts came up";
}

}  // namespace
}  // namespace dynslam
