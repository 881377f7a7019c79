// SPDX-License-Identifier: MIT
#include "sim/ray_caster.h"

#include <gtest/gtest.h>

#include "sim/actors.h"
#include "sim/random_stream.h"
#include "sim/small_world.h"

namespace dynslam {
namespace {

SpaceRay ray_from(double x, double y, double yaw, double height_m = 0.18, double slope = 0.0) {
  SpaceRay ray;
  ray.from = {x, y};
  ray.direction = unit(yaw);
  ray.height_m = height_m;
  ray.slope = slope;
  return ray;
}

RayCaster caster_of(const World& world) { return {fixed_surfaces(world), Actors::reach(world)}; }

double distance(const RayCaster& caster, const SpaceRay& ray) {
  const auto hit = caster.cast(ray);
  return hit ? hit->distance_m : -1.0;
}

TEST(RayCaster, MeetsTheNearestThing) {
  World world = bare_room();
  world.furniture.push_back(box_at(5, 3, 0.5, 0.0, 1.0));
  const RayCaster caster = caster_of(world);
  EXPECT_NEAR(distance(caster, ray_from(2, 3, 0)), 2.75, 1e-9);
  EXPECT_NEAR(distance(caster, ray_from(2, 3, kPi)), 1.95, 1e-9);
  EXPECT_NEAR(distance(caster, ray_from(2, 3, kPi / 2)), 2.95, 1e-9);
  EXPECT_NEAR(distance(caster, ray_from(2, 2, 0)), 5.95, 1e-9);
}

TEST(RayCaster, HeightsDecide) {
  World world = bare_room();
  world.furniture.push_back(box_at(4, 3, 0.5, 0.0, 0.10));
  world.furniture.push_back(box_at(6, 3, 0.5, 0.60, 0.70));
  const RayCaster caster = caster_of(world);
  EXPECT_NEAR(distance(caster, ray_from(2, 3, 0)), 5.95, 1e-9) << "over one and under the other";
  EXPECT_NEAR(distance(caster, ray_from(2, 3, 0, 0.18, -0.06)), 1.75, 1e-9)
      << "nose down it meets the low one";
  EXPECT_NEAR(distance(caster, ray_from(2, 3, 0, 0.18, 0.12)), 3.75, 1e-9) << "nose up the high one";
  EXPECT_EQ(distance(caster, ray_from(2, 3, 0, 0.18, 0.5)), -1.0) << "or passes over the wall";
}

TEST(RayCaster, SinkingBeamsEndOnTheFloor) {
  const RayCaster caster = caster_of(bare_room());
  const auto hit = caster.cast(ray_from(2, 3, 0, 0.18, -0.09));
  ASSERT_TRUE(hit.has_value());
  EXPECT_EQ(hit->surface, nullptr);
  EXPECT_NEAR(hit->distance_m, 2.0, 1e-9);
}

TEST(RayCaster, SeesGlassOnlySquarely) {
  World world = bare_room();
  Wall pane{{{5, 0.5}, {5, 5.5}}};
  pane.glass = true;
  world.walls.push_back(pane);
  const RayCaster caster = caster_of(world);
  SpaceRay square = ray_from(2, 3, 0), slanting = ray_from(2, 3, 0.5);
  square.glass_cosine = slanting.glass_cosine = 0.98;
  EXPECT_NEAR(distance(caster, square), 2.95, 1e-9);
  EXPECT_GT(distance(caster, slanting), 6.0);
}

TEST(RayCaster, ForgetsWhereThingsWere) {
  RayCaster caster = caster_of(bare_room());
  std::vector<Surface> there, elsewhere;
  add_surfaces(box_at(4, 3, 0.5, 0, 1).parts.front(), {4, 3, 0}, 0, there);
  add_surfaces(box_at(4, 3, 0.5, 0, 1).parts.front(), {4, 5, 0}, 0, elsewhere);
  caster.set_moving(there);
  EXPECT_NEAR(distance(caster, ray_from(2, 3, 0)), 1.75, 1e-9);
  caster.set_moving(elsewhere);
  EXPECT_NEAR(distance(caster, ray_from(2, 3, 0)), 5.95, 1e-9);
}

TEST(RayCaster, SeesThingsInOrderUntilAWall) {
  World world = bare_room();
  world.furniture.push_back(box_at(5, 3, 0.5, 0.6, 0.7));
  const RayCaster caster = caster_of(world);
  std::vector<RayHit> hits;
  caster.cast_through(ray_from(2, 3, 0), 2.5, hits);
  ASSERT_GE(hits.size(), 3U);
  EXPECT_NEAR(hits[0].distance_m, 2.75, 1e-9);
  EXPECT_TRUE(hits[0].enters);
  EXPECT_NEAR(hits[1].distance_m, 3.25, 1e-9);
  EXPECT_FALSE(hits[1].enters);
  EXPECT_NEAR(hits[2].distance_m, 5.95, 1e-9);
}

/// A world of sticks and posts of all heights, seeded.
std::vector<Surface> random_faces(RandomStream& random, int count) {
  std::vector<Surface> faces;
  for (int i = 0; i < count; ++i) {
    Surface face;
    face.from = {random.uniform(0, 20), random.uniform(0, 12)};
    if (i % 3 == 0) {
      face.radius_m = random.uniform(0.02, 0.5);
    } else {
      face.along = random.uniform(0.05, 3.0) * unit(random.uniform(-kPi, kPi));
    }
    face.low_m = random.uniform(-0.2, 0.3);
    face.high_m = face.low_m + random.uniform(0.05, 1.0);
    face.glass = i % 7 == 0;
    face.part = i;
    faces.push_back(face);
  }
  return faces;
}

TEST(RayCaster, FindsWhatBruteForceFinds) {
  RandomStream random(11, 0);
  int hits = 0;
  for (int world = 0; world < 20; ++world) {
    RayCaster caster(random_faces(random, 20 + 10 * world), {{-4, -4}, {24, 16}});
    caster.set_moving(random_faces(random, 12));
    for (int i = 0; i < 500; ++i) {
      const double x = random.uniform(-1, 21), y = random.uniform(-1, 13);
      SpaceRay ray = ray_from(x, y, random.uniform(-kPi, kPi));
      if (i % 3 == 0) ray.slope = random.uniform(-0.1, 0.1);
      if (i % 10 == 0) ray.direction = Vector2(0, i % 20 == 0 ? 1 : -1);  // along the buckets' borders
      if (i % 5 == 0) ray.max_m = random.uniform(0.5, 10.0);
      ray.glass_cosine = random.uniform();
      const auto fast = caster.cast(ray), slow = caster.cast_by_brute_force(ray);
      ASSERT_EQ(fast.has_value(), slow.has_value()) << "world " << world << ", ray " << i;
      if (!fast) continue;
      ++hits;
      ASSERT_EQ(fast->distance_m, slow->distance_m) << "world " << world << ", ray " << i;
      ASSERT_EQ(fast->surface == nullptr, slow->surface == nullptr);
    }
  }
  EXPECT_GT(hits, 5000) << "the worlds are too empty to say anything";
}

}  // namespace
}  // namespace dynslam
