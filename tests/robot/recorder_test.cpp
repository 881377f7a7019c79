// SPDX-License-Identifier: MIT
#include <algorithm>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/mcap_channels.h"
#include "robot/recorder_stage.h"
#include "robot/replay.h"
#include "robot/robot.h"
#include "sim/small_world.h"
#include "tests/io/read_all.h"

namespace dynslam {
namespace {

namespace fs = std::filesystem;
using test::Contents;
using test::read_all;
using testing::HasSubstr;

constexpr Duration kStep = std::chrono::milliseconds(10);

std::string contents(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// How many messages each topic has, and when the last of all was heard of.
struct Topics {
  std::map<std::string, int> messages;
  Time last;
};

Topics topics_of(const fs::path& path) {
  Topics topics;
  Counters ignored;
  MemorySource source(contents(path));
  McapStream stream(source, ignored);
  McapChannels channels;
  while (const auto record = stream.next()) {
    channels.take(*record);
    if (record->opcode != McapOpcode::kMessage) continue;
    const auto message = parse_mcap_message(record->content);
    ++topics.messages[channels.find(message->channel_id)->topic];
    topics.last = std::max(topics.last, Time(Duration(static_cast<std::int64_t>(message->log_time_ns))));
  }
  return topics;
}

/// A folder of its own for each test, gone afterwards.
class Recorder : public ::testing::Test {
 protected:
  Recorder() {
    std::string pattern = fs::temp_directory_path() / "dynslam-test-XXXXXX";
    folder_ = mkdtemp(pattern.data());
    config_.recorder.folder = folder_ / "kept";
    config_.recorder.free_floor_mib = 0;
  }
  ~Recorder() override { fs::remove_all(folder_); }

  std::vector<fs::path> files() const {
    std::vector<fs::path> found;
    if (fs::exists(folder_ / "kept"))
      for (const auto& entry : fs::directory_iterator(folder_ / "kept")) found.push_back(entry.path());
    std::sort(found.begin(), found.end());
    return found;
  }

  fs::path folder_;
  RobotConfig config_;
};

/// Wheels that roll 2 % further than they should.
class SlippingWheels : public Wheels {
 public:
  explicit SlippingWheels(SteppedSim& sim) : sim_(sim), due_(sim.clock.now()) {}
  std::optional<OdometrySample> next(Time) override {
    if (sim_.clock.now() < due_) return std::nullopt;
    Pose2 pose = sim_.simulator->true_pose(due_).value_or(Pose2());
    pose.x *= 1.02, pose.y *= 1.02;
    return OdometrySample{std::exchange(due_, due_ + std::chrono::milliseconds(20)), pose};
  }

 private:
  SteppedSim& sim_;
  Time due_;
};

enum class Encoders { kNone, kThere };

Devices devices_of(SteppedSim& sim, Encoders encoders) {
  Devices devices = make_devices(sim.simulator);
  if (encoders == Encoders::kThere) devices.wheels = std::make_unique<SlippingWheels>(sim);
  return devices;
}

/// A robot in a bare room that drives in a circle, step by step.
struct SteppedRobot {
  explicit SteppedRobot(const RobotConfig& config, Encoders encoders = Encoders::kNone)
      : sim(bare_room()), robot(devices_of(sim, encoders), config, sim.clock) {
    robot.on_scan([this](const ScanResult& r) { live.push_back({r.stamp, r.map_T_robot}); });
  }
  void go_on(double seconds) {
    const Time end = sim.clock.now() + from_seconds(seconds);
    for (int i = 0; sim.clock.now() < end; ++i) {
      sim.clock.set(sim.clock.now() + kStep);
      const bool moves = sim.clock.now() > sim.begin + std::chrono::seconds(1);
      if (i % 5 == 0) robot.ports().command.put({++seq, moves ? Twist{0.3, 0.4} : Twist{}, sim.clock.now()});
      robot.step();
    }
  }
  void wish(bool on, const std::string& file = {}) { robot.ports().recording_wish.put({on, file}); }
  RecordingState state() { return *robot.ports().recording.get().value; }

  SteppedSim sim;
  Robot robot;
  std::vector<StampedPose> live;
  std::uint64_t seq = 0;
};

TEST_F(Recorder, HasAllThatTheRobotSensesDecidesAndIsTold) {
  config_.recorder.camera = true;
  SteppedRobot r(config_, Encoders::kThere);
  r.robot.ports().log.push({r.sim.clock.now(), LogLevel::kWarn, "a line of the log"});
  r.wish(true, folder_ / "all.mcap");
  r.go_on(12.0);
  EXPECT_TRUE(r.state().active);
  r.wish(false);
  r.go_on(0.5);
  EXPECT_FALSE(r.state().active);
  EXPECT_EQ(r.state().trouble, "");
  EXPECT_NEAR(r.state().seconds, 12.0, 0.1);
  EXPECT_EQ(r.state().bytes, fs::file_size(folder_ / "all.mcap"));
  EXPECT_EQ(r.robot.ports().watchers, 0);

  auto topics = topics_of(folder_ / "all.mcap").messages;
  EXPECT_NEAR(topics["/scan"], 119, 2);
  EXPECT_NEAR(topics["/imu"], 1200, 20);
  EXPECT_NEAR(topics["/wheel_odom"], 600, 10);
  EXPECT_NEAR(topics["/odom"], 118, 3);
  EXPECT_EQ(topics["/tf"], topics["/odom"]);
  EXPECT_EQ(topics["/tf_static"], 1);
  EXPECT_NEAR(topics["/cmd_vel"], 240, 5);
  EXPECT_NEAR(topics["/cmd_vel_applied"], 600, 5);
  EXPECT_NEAR(topics["/battery"], 12, 2);
  EXPECT_NEAR(topics["/map"], 3, 1);
  EXPECT_GE(topics["/diagnostics"], 12);
  EXPECT_GE(topics["/rosout"], 3);
  EXPECT_GT(topics["/camera/compressed"], 50);
  EXPECT_EQ(topics.size(), 13U);
  int sum = 0;
  for (const auto& [topic, n] : topics) sum += n;
  EXPECT_EQ(r.state().messages, static_cast<std::uint64_t>(sum));
}

TEST_F(Recorder, ReplayGivesTheMapThatTheRobotHad) {
  config_.lidar_mount = {};
  SteppedRobot r(config_);
  r.wish(true, folder_ / "a.mcap");
  r.go_on(25.0);
  r.robot.finish();
  MappingResult own;
  take_result(r.robot.slam(), own);

  const auto recording = open_recording(folder_ / "a.mcap");
  const ReplayFrames follow{1'000'000, {}};
  const MappingResult again = replay(
      *recording, config_.slam, [](double, std::uint64_t) {}, follow);
  EXPECT_EQ(recording->damage(), std::nullopt);
  ASSERT_GE(again.trajectory_live.size(), r.live.size());
  for (std::size_t i = 0; i < r.live.size(); ++i) {
    ASSERT_EQ(again.trajectory_live[i].stamp, r.live[i].stamp);
    ASSERT_EQ(again.trajectory_live[i].map_T_robot, r.live[i].map_T_robot) << "scan " << i;
  }
  EXPECT_GT(r.live.back().map_T_robot.translation().norm(), 0.1);
  EXPECT_EQ(again.map.chunk_count(), own.map.chunk_count());
}

TEST_F(Recorder, ReplayGoesByTheWheelsToo) {
  config_.lidar_mount = {};
  SteppedRobot r(config_, Encoders::kThere);
  r.wish(true, folder_ / "a.mcap");
  r.go_on(10.0);
  r.robot.finish();
  const auto recording = open_recording(folder_ / "a.mcap");
  const ReplayFrames follow{1'000'000, {}};
  const MappingResult again = replay(
      *recording, config_.slam, [](double, std::uint64_t) {}, follow);
  ASSERT_GE(again.trajectory_live.size(), r.live.size());
  for (std::size_t i = 0; i < r.live.size(); ++i) {
    ASSERT_EQ(again.trajectory_live[i].stamp, r.live[i].stamp);
    const Pose2 off = r.live[i].map_T_robot.inverse() * again.trajectory_live[i].map_T_robot;
    // Not to the bit: the heading of the wheels is written as a quaternion.
    ASSERT_LT(off.translation().norm() + std::abs(off.yaw), 1e-9) << "scan " << i;
  }
}

TEST_F(Recorder, GivesTheSameBytesTwice) {
  for (const char* name : {"a.mcap", "b.mcap"}) {
    SteppedRobot r(config_);
    r.wish(true, folder_ / name);
    r.go_on(3.0);
    r.robot.finish();
  }
  const std::string bytes = contents(folder_ / "a.mcap");
  EXPECT_GT(bytes.size(), 10'000U);
  EXPECT_TRUE(bytes == contents(folder_ / "b.mcap"));
}

// What a SIGKILL leaves is what was given to the system by then: the file as it is on the disk meanwhile.
TEST_F(Recorder, AtAnyMomentTheFileIsGoodUpToTheLastSecond) {
  SteppedRobot r(config_);
  r.wish(true, folder_ / "a.mcap");
  r.go_on(2.0);
  for (int i = 0; i < 20; ++i) {
    r.go_on(0.17);
    ASSERT_GE(topics_of(folder_ / "a.mcap").last, r.sim.clock.now() - std::chrono::seconds(1)) << i;
  }
}

TEST_F(Recorder, NothingIsWrittenWithoutAWish) {
  SteppedRobot r(config_);
  r.go_on(2.0);
  r.wish(false);
  r.go_on(1.0);
  EXPECT_TRUE(files().empty());
  EXPECT_EQ(r.robot.ports().recording.get().value, nullptr);
}

TEST_F(Recorder, EachWishIsAFileOfItsOwn) {
  SteppedRobot r(config_);
  for (int i = 0; i < 3; ++i) {
    r.wish(true);
    r.go_on(0.3);
    r.wish(true);
    r.go_on(0.3);
    r.wish(false);
    r.go_on(0.2);
  }
  ASSERT_EQ(files().size(), 3U) << "asking twice is asking once";
  for (const fs::path& file : files()) EXPECT_EQ(read_all(contents(file)).damage, std::nullopt);
  EXPECT_GT(topics_of(files()[0]).messages["/scan"], 3);
}

TEST_F(Recorder, TheRingIsBoundedAndGivesWayToAWish) {
  config_.recorder.always = true;
  config_.recorder.ring_mib = 3;
  config_.recorder.file_mib = 1;
  SteppedRobot r(config_);
  std::uint64_t most = 0;
  for (int i = 0; i < 150; ++i) {
    r.go_on(1.0);
    std::uint64_t sum = 0;
    for (const fs::path& file : files()) sum += fs::file_size(file);
    most = std::max(most, sum);
  }
  EXPECT_GT(most, 3U << 19);
  EXPECT_LT(most, (3U << 20) + (1U << 18)) << "a chunk over at most";
  EXPECT_FALSE(fs::exists(folder_ / "kept/ring-00000001.mcap")) << "the oldest went";
  for (const fs::path& file : files()) EXPECT_GT(topics_of(file).messages["/scan"], 0) << file;
  EXPECT_FALSE(r.state().asked_for);

  r.wish(true);
  r.go_on(1.0);
  EXPECT_TRUE(r.state().asked_for);
  EXPECT_THAT(r.state().file, HasSubstr("recording-"));
  r.wish(false);
  r.go_on(1.0);
  EXPECT_TRUE(r.state().active);
  EXPECT_THAT(r.state().file, HasSubstr("ring-"));
}

TEST_F(Recorder, AFullDiskEndsTheRecordingAndNotTheRobot) {
  config_.recorder.free_floor_mib = 1'000'000;
  SteppedRobot r(config_);
  r.wish(true);
  r.go_on(2.0);
  EXPECT_FALSE(r.state().active);
  EXPECT_THAT(r.state().trouble, HasSubstr("MiB are to stay free"));
  EXPECT_TRUE(files().empty());
  EXPECT_GT(r.live.size(), 10U);
}

TEST_F(Recorder, ARingThatCannotBeWrittenIsTriedAgain) {
  std::ofstream(folder_ / "kept") << "in the way";
  config_.recorder.always = true;
  SteppedRobot r(config_);
  r.go_on(2.0);
  EXPECT_FALSE(r.state().active);
  EXPECT_THAT(r.state().trouble, HasSubstr("kept"));
  fs::remove(folder_ / "kept");
  r.go_on(11.0);
  EXPECT_TRUE(r.state().active);
  EXPECT_EQ(r.state().trouble, "");
}

TEST_F(Recorder, EndsAtTheSizeThatARecordingMayHave) {
  config_.recorder.most_mib = 1;
  SteppedRobot r(config_);
  r.wish(true);
  r.go_on(60.0);
  EXPECT_FALSE(r.state().active);
  EXPECT_THAT(r.state().trouble, HasSubstr("most_mib"));
  EXPECT_LT(fs::file_size(files().at(0)), 5U << 18);
  EXPECT_EQ(read_all(contents(files()[0])).damage, std::nullopt);
}

TEST_F(Recorder, WhatComesFasterThanItIsWrittenIsDroppedAndCounted) {
  SteppedClock clock;
  Ports ports;
  RecorderStage recorder(config_.recorder, {}, clock, ports);
  recorder.add(ImuSample{});
  ports.recording_wish.put({true, folder_ / "a.mcap"});
  recorder.turn();
  EXPECT_EQ(recorder.dropped(), 0U);
  for (int i = 0; i < 300; ++i) recorder.add(ImuSample{clock.now() + Duration(i + 1)});
  EXPECT_EQ(recorder.dropped(), 300U - RecorderStage::kQueue);
  recorder.finish();
  EXPECT_EQ(ports.recording.get().value->dropped, 300U - RecorderStage::kQueue);
  const Contents all = read_all(contents(folder_ / "a.mcap"));
  ASSERT_EQ(all.imu.size(), RecorderStage::kQueue);
  EXPECT_EQ(all.imu.front().stamp, Time(Duration(300 - 256 + 1))) << "the oldest went";
}

TEST_F(Recorder, BeginsAndEndsWhileTheRobotLives) {
  const RunningClock clock;
  config_.recorder.always = true;
  Devices devices = make_devices(std::make_shared<Simulator>(bare_room(), clock, 1));
  devices.lidar.reset();  // stopping would wait for SLAM, which takes its time under a sanitizer
  Robot robot(std::move(devices), config_, clock);
  robot.start();
  Ports& ports = robot.ports();
  const auto until = [&](auto&& is_so) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    auto seen = ports.recording.get();
    while (!(seen.value && is_so(*seen.value)) && std::chrono::steady_clock::now() < deadline)
      seen = ports.recording.wait(seen.version, deadline);
    return seen.value && is_so(*seen.value);
  };
  EXPECT_TRUE(until([](const RecordingState& s) { return s.active && !s.asked_for && s.messages > 50; }));
  ports.recording_wish.put({true, {}});
  EXPECT_TRUE(until([](const RecordingState& s) { return s.active && s.asked_for && s.messages > 50; }));
  ports.recording_wish.put({false, {}});
  EXPECT_TRUE(until([](const RecordingState& s) { return s.active && !s.asked_for; }));
  const Robot::Ending ending = robot.stop(std::chrono::seconds(5));
  EXPECT_EQ(ending.trouble, "");
  EXPECT_FALSE(ending.hangs);
  EXPECT_FALSE(ports.recording.get().value->active);
  ASSERT_EQ(files().size(), 3U);
  for (const fs::path& file : files()) EXPECT_EQ(read_all(contents(file)).damage, std::nullopt) << file;
  EXPECT_THAT(contents(files()[0]), HasSubstr("begun_utc"));
}

TEST_F(Recorder, NamesSortAsTheyWereMadeWhateverTheClockDoes) {
  const SteppedClock clock;
  Ports ports;
  WallTime wall = std::chrono::sys_days(std::chrono::year(2026) / 11 / 26);
  RecorderStage recorder(config_.recorder, {}, clock, ports);
  recorder.run_live([&wall] { return wall; });
  std::vector<std::string> made;
  for (const int years : {0, 0, -56, 57, -1, 0}) {
    wall += std::chrono::years(years);
    ports.recording_wish.put({true, {}});
    recorder.turn();
    made.push_back(ports.recording.get().value->file);
    ports.recording_wish.put({false, {}});
    recorder.turn();
  }
  EXPECT_TRUE(std::is_sorted(made.begin(), made.end()));
  ASSERT_EQ(files().size(), made.size()) << "none over another";
  EXPECT_THAT(made[0], HasSubstr("recording-20261126-000000.mcap"));
  EXPECT_THAT(made[2], HasSubstr("recording-20261126-000002.mcap"));
  for (const fs::path& file : files()) EXPECT_EQ(read_all(contents(file)).damage, std::nullopt) << file;
}

}  // namespace
}  // namespace dynslam
