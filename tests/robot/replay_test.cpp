// SPDX-License-Identifier: MIT
#include "robot/replay.h"

#include <sstream>

#include <gtest/gtest.h>

#include "grid/trinary_map.h"
#include "io/open_recording.h"
#include "slam/drawn_world.h"
#include "support_matchers.h"

namespace dynslam {
namespace {

/// A CARMEN log of a robot that drives one metre through the two rooms.
std::string short_log() {
  const DrawnWorld world = two_rooms();
  std::ostringstream text;
  text << "PARAM laser_front_laser_fov 3.14159 0 radish 0\n";
  for (int i = 0; i < 30; ++i) {
    const Pose2 at{2.0 + 0.05 * i, 2.4, 0.02 * i};
    const double stamp = 10 + 0.2 * i;
    text << "FLASER 181";
    for (int k = 0; k <= 180; ++k) text << ' ' << world.distance(at.translation(), at.yaw + radians(k - 90));
    for (int twice = 0; twice < 2; ++twice) text << ' ' << at.x << ' ' << at.y << ' ' << at.yaw;
    text << ' ' << stamp << " host " << stamp << '\n';
  }
  return text.str();
}

MappingResult replay_text(const std::string& text) {
  const auto recording = open_recording(std::make_unique<MemorySource>(text, "short.log"), RecordingConfig{});
  return replay(*recording, {}, [](double, std::uint64_t) {});
}

TEST(Replay, MapsARecording) {
  const MappingResult result = replay_text(short_log());
  ASSERT_EQ(result.trajectory.size(), 30U);
  EXPECT_EQ(result.inserted, 30U);
  EXPECT_THAT(result.trajectory.back().map_T_robot, PoseNear(Pose2{1.45, 0, 0.58}, 0.02, 0.01));
  EXPECT_GT(result.map.chunk_count(), 10U);
  EXPECT_GT(trinary_map(result.map).width, 100);
  EXPECT_EQ(result.scan_ms.size(), 30U);
  EXPECT_EQ(result.stages_ms.size(), 3U) << "the map is drawn at the end";
  EXPECT_GT(result.local_maps, 0U);
}

TEST(Replay, IsTheSameTwice) {
  const MappingResult a = replay_text(short_log()), b = replay_text(short_log());
  EXPECT_EQ(to_tum(a.trajectory), to_tum(b.trajectory));
  EXPECT_EQ(trinary_map(a.map).cells, trinary_map(b.map).cells);
}

TEST(Replay, OfNoScansIsEmpty) {
  const MappingResult result = replay_text("PARAM laser_front_laser_fov 3.14159 0 radish 0\n");
  EXPECT_TRUE(result.trajectory.empty());
  EXPECT_EQ(result.map.chunk_count(), 0U);
}

}  // namespace
}  // namespace dynslam
