// SPDX-License-Identifier: MIT
#include "sim/camera_picture.h"

#include <gtest/gtest.h>

#include "sim/small_world.h"

namespace dynslam {
namespace {

using namespace std::chrono_literals;

constexpr Colour kRed = 0xd01010, kGreen = 0x10c010;

struct Channels {
  int r, g, b;
};

Channels at(const Picture& picture, int x, int y) {
  const std::uint32_t p = picture.pixels[static_cast<std::size_t>(y) * picture.width + x];
  return {static_cast<int>(p >> 16 & 255U), static_cast<int>(p >> 8 & 255U), static_cast<int>(p & 255U)};
}

bool is_red(const Channels& c) { return c.r > 2 * c.g && c.r > 2 * c.b; }
bool is_green(const Channels& c) { return c.g > 2 * c.r && c.g > 2 * c.b; }

Picture drawn(const World& world, const BodyPose& pose) {
  CameraPicture picture(world);
  return picture.draw({Time(), pose, {}});
}

World with_boxes() {
  World world = bare_room();
  world.floors.push_back({{{0, 0}, {8, 0}, {8, 6}, {0, 6}}, 0x808080});
  Furniture left = box_at(4, 3.8, 0.6, 0, 0.6), right = box_at(4, 2.2, 0.6, 0.5, 0.8);
  left.parts.front().colour = kRed;
  right.parts.front().colour = kGreen;
  world.furniture = {left, right};
  return world;
}

BodyPose looking_from(double x, double y, double yaw) {
  BodyPose pose;
  pose.world_T_robot = {x, y, yaw};
  return pose;
}

TEST(CameraPicture, ShowsThingsWhereTheyAre) {
  const Picture picture = drawn(with_boxes(), looking_from(2, 3, 0));
  const int horizon = 270 + 74;
  const auto column = [](double across_m, double ahead_m) {
    return static_cast<int>(480 -
                            CameraPicture::kFocal_px * across_m / (ahead_m - CameraPicture::kForward_m));
  };
  EXPECT_TRUE(is_red(at(picture, column(0.8, 1.7), horizon - 10)));
  EXPECT_FALSE(is_red(at(picture, 480, horizon - 10))) << "between them is the wall";
  EXPECT_TRUE(is_green(at(picture, column(-0.8, 1.7), horizon - 180)));
  EXPECT_FALSE(is_green(at(picture, column(-0.8, 1.7), horizon - 20))) << "below it one looks through";
}

TEST(CameraPicture, SeesTheUndersideOfWhatItStandsUnder) {
  World world = bare_room();
  Furniture table = box_at(2, 3, 3.2, 0.6, 0.65);
  table.parts.front().colour = kGreen;
  world.furniture = {table};
  const Picture picture = drawn(world, looking_from(2, 3, 0));
  EXPECT_TRUE(is_green(at(picture, 480, 2)));
  EXPECT_FALSE(is_green(at(picture, 480, 400)));
}

TEST(CameraPicture, NoseUpLowersTheHorizon) {
  BodyPose up = looking_from(2, 3, 0);
  up.nose_up_rad = 0.05;
  const World world = with_boxes();
  const auto floor_rows = [&](const BodyPose& pose) {
    const Picture picture = drawn(world, pose);
    int rows = 0;
    for (int y = 0; y < picture.height; ++y) {
      const Channels c = at(picture, 480, y);
      rows += std::abs(c.r - c.g) < 4 && std::abs(c.g - c.b) < 4 && c.r < 160 ? 1 : 0;
    }
    return rows;
  };
  EXPECT_NEAR(floor_rows(looking_from(2, 3, 0)) - floor_rows(up), 37, 6);
}

TEST(SimCamera, TakesTwentyPicturesASecond) {
  SteppedSim sim(bare_room());
  sim.go_to(0.049);
  EXPECT_FALSE(sim.devices.camera->next(sim.clock.now()).has_value());
  sim.go_to(0.26);
  const auto frame = sim.devices.camera->next(sim.clock.now());
  ASSERT_TRUE(frame.has_value());
  EXPECT_EQ(frame->stamp, sim.begin + 250ms) << "the newest one; what nobody asked for was not drawn";
  EXPECT_FALSE(sim.devices.camera->next(sim.clock.now()).has_value());
  ASSERT_GT(frame->bytes.size(), 4000U);
  EXPECT_EQ(frame->bytes[0], 0xff);
  EXPECT_EQ(frame->bytes[1], 0xd8);
}

TEST(SimCamera, DrawsTheSameTwice) {
  std::vector<std::uint8_t> first;
  for (int run = 0; run < 2; ++run) {
    SteppedSim sim(load_world("apartment"));
    sim.go_to(3.0);
    const auto frame = sim.devices.camera->next(sim.clock.now());
    ASSERT_TRUE(frame.has_value());
    if (run == 0) first = frame->bytes;
    EXPECT_EQ(frame->bytes, first);
  }
}

}  // namespace
}  // namespace dynslam
