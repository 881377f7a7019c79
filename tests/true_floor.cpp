// SPDX-License-Identifier: MIT
#include "true_floor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <map>

#include "autopilot/exploration_config.h"
#include "sim/actors.h"
#include "sim/life.h"
#include "sim/robot_shape.h"

namespace dynslam {
namespace {

constexpr std::size_t kBeams = 1200;

std::vector<Surface> all_surfaces(const World& world) {
  std::vector<Surface> all = fixed_surfaces(world);
  const std::vector<Surface> doors = Actors(world).surfaces();
  all.insert(all.end(), doors.begin(), doors.end());
  return all;
}

/// Points along a face's outline as the floor sees it.
template <class Visit>
void for_each_point(const Surface& s, double step_m, Visit&& visit) {
  const double length_m = s.radius_m > 0 ? kTwoPi * s.radius_m : s.along.norm();
  const int steps = 1 + static_cast<int>(length_m / step_m);
  for (int i = 0; i <= steps; ++i) {
    const double share = static_cast<double>(i) / steps;
    visit(s.radius_m > 0 ? Vector2(s.from + s.radius_m * unit(kTwoPi * share))
                         : Vector2(s.from + share * s.along));
  }
}

}  // namespace

TrueFloor::TrueFloor(const World& world) : caster_(all_surfaces(world), Actors::reach(world)) {
  draw_costmap(all_surfaces(world));
  find_floor(world);
}

/// What is inside of things counts as free; nobody gets there.
void TrueFloor::draw_costmap(const std::vector<Surface>& surfaces) {
  const double cell_m = costmap_.cell_size_m();
  std::map<ChunkIndex, CellTile> occupied;
  for (const Surface& s : surfaces) {
    if (s.low_m >= kRobotHigh_m || s.high_m <= kRobotLow_m) continue;
    for_each_point(s, cell_m / 2, [&](const Vector2& p) {
      const CellIndex c = cell_at(p, cell_m);
      occupied[chunk_of(c)][static_cast<std::size_t>(c.y & kChunkMask)] |= std::uint64_t{1}
                                                                           << (c.x & kChunkMask);
    });
  }
  ChunkedGrid grid(cell_m);
  const ChunkIndex low = chunk_of(cell_at(caster_.low_corner(), cell_m));
  const ChunkIndex high = chunk_of(cell_at(caster_.high_corner(), cell_m));
  for (ChunkIndex at = low; at.y <= high.y; ++at.y) {
    for (at.x = low.x; at.x <= high.x; ++at.x) {
      const CellTile& walls = occupied[at];
      CellTile free;
      std::transform(walls.begin(), walls.end(), free.begin(), [](std::uint64_t row) { return ~row; });
      grid.show(at, free, walls);
    }
  }
  costmap_.update(grid.snapshot());
}

void TrueFloor::find_floor(const World& world) {
  const std::vector<Vector2> floor = Life(world, Time(), 1).reachable_floor(kCell_m);
  Vector2 high = low_ = world.world_T_start.translation();
  for (const Vector2& p : floor) {
    low_ = low_.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  low_.array() -= kCell_m;
  const auto steps = [&](double m) { return static_cast<std::size_t>(std::lround(m / kCell_m)); };
  columns_ = steps(high.x() - low_.x()) + 2;
  cells_.assign(columns_ * (steps(high.y() - low_.y()) + 2), Look::kNoFloor);
  for (const Vector2& p : floor)
    cells_[steps(p.y() - low_.y()) * columns_ + steps(p.x() - low_.x())] = Look::kUnseen;
}

Vector2 TrueFloor::middle(std::size_t cell) const {
  return low_ + kCell_m * Vector2(static_cast<double>(cell % columns_), static_cast<double>(cell / columns_));
}

void TrueFloor::look(const Vector2& from, double range_m) {
  std::array<double, kBeams> reach_m;
  for (std::size_t i = 0; i < kBeams; ++i) {
    SpaceRay ray;
    ray.from = from;
    ray.height_m = kLidarHeight_m;
    ray.direction = unit(kTwoPi * static_cast<double>(i) / kBeams);
    ray.max_m = range_m;
    const auto hit = caster_.cast(ray);
    reach_m[i] = hit ? hit->distance_m : range_m;
  }
  for (std::size_t cell = 0; cell < cells_.size(); ++cell) {
    if (cells_[cell] != Look::kUnseen) continue;
    const Vector2 to = middle(cell) - from;
    if (to.squaredNorm() > range_m * range_m) continue;
    const double turns = std::atan2(to.y(), to.x()) / kTwoPi;
    const auto beam = static_cast<std::size_t>(std::lround((turns + 1.0) * kBeams)) % kBeams;
    if (to.norm() < reach_m[beam]) cells_[cell] = Look::kSeen;
  }
}

template <class Visit>
void TrueFloor::for_each_beside(std::size_t cell, Visit&& visit) const {
  if (cells_[cell] == Look::kNoFloor) return;
  for (const std::size_t next : {cell + 1, cell - 1, cell + columns_, cell - columns_}) visit(next);
}

bool TrueFloor::is_frontier(std::size_t cell) const {
  bool beside_unseen = false;
  for_each_beside(cell, [&](std::size_t next) { beside_unseen |= cells_[next] == Look::kUnseen; });
  return beside_unseen && cells_[cell] == Look::kSeen;
}

/// Unseen cells that hang together over the diagonal that a frontier must have.
std::vector<bool> TrueFloor::large_patches() const {
  std::vector<bool> large(cells_.size()), met(cells_.size());
  for (std::size_t first = 0; first < cells_.size(); ++first) {
    if (cells_[first] != Look::kUnseen || met[first]) continue;
    std::vector<std::size_t> patch = {first};
    met[first] = true;
    Vector2 low = middle(first), high = low;
    for (std::size_t i = 0; i < patch.size(); ++i) {
      low = low.cwiseMin(middle(patch[i]));
      high = high.cwiseMax(middle(patch[i]));
      for_each_beside(patch[i], [&](std::size_t next) {
        if (cells_[next] != Look::kUnseen || met[next]) return;
        met[next] = true;
        patch.push_back(next);
      });
    }
    const Vector2 size = high - low + Vector2(kCell_m, kCell_m);
    if (size.norm() < ExplorationConfig{}.least_extent_m) continue;
    for (const std::size_t cell : patch) large[cell] = true;
  }
  return large;
}

std::vector<std::size_t> TrueFloor::frontier() const {
  const std::vector<bool> large = large_patches();
  std::vector<std::size_t> frontier;
  for (std::size_t cell = 0; cell < cells_.size(); ++cell) {
    if (cells_[cell] != Look::kSeen) continue;
    bool beside_large = false;
    for_each_beside(cell, [&](std::size_t next) { beside_large |= large[next]; });
    if (beside_large) frontier.push_back(cell);
  }
  return frontier;
}

double TrueFloor::seen_share() const {
  const auto seen = std::count(cells_.begin(), cells_.end(), Look::kSeen);
  const auto unseen = std::count(cells_.begin(), cells_.end(), Look::kUnseen);
  return seen + unseen > 0 ? static_cast<double>(seen) / static_cast<double>(seen + unseen) : 1.0;
}

}  // namespace dynslam
