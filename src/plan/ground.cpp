// SPDX-License-Identifier: MIT
#include "plan/ground.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "grid/ray_walk.h"

namespace dynslam {
namespace {

/// A leg is walked in pieces of so many cells, and ends with the first that is blocked.
constexpr double kPiece_cells = 32;

}  // namespace

std::uint8_t clearance_steps_for(double clearance_m) {
  return static_cast<std::uint8_t>(std::clamp(std::ceil(clearance_m / kClearanceStep_m - 1e-6), 1.0,
                                              Costmap::kReach_m / kClearanceStep_m));
}

Ground::Ground(const PlannerConfig& config, double least_clearance_m, Unknown unknown)
    : least_clearance_(clearance_steps_for(least_clearance_m)) {
  const double band_m = config.comfort_m - least_clearance_m;
  for (std::size_t steps = least_clearance_; steps < 256; ++steps) {
    const double lacking_m = config.comfort_m - static_cast<double>(steps) * kClearanceStep_m;
    const double tightness = band_m > 0 ? std::clamp(lacking_m / band_m, 0.0, 1.0) : 0.0;
    const double price = kUnit * (1 + config.comfort_weight * tightness);
    const auto rounded = [](double p) {
      return static_cast<std::uint16_t>(std::clamp(std::round(p), double{kUnit}, double{kMostPrice}));
    };
    prices_[1][steps] = rounded(price);
    prices_[3][steps] = rounded(price * config.post_weight);
    if (unknown != Unknown::kDear) continue;
    prices_[0][steps] = rounded(price * config.unknown_weight);
    prices_[2][steps] = rounded(price * config.unknown_weight * config.post_weight);
  }
}

std::optional<double> leg_cost(const Costmap& map, const Ground& ground, const Vector2& from_map,
                               const Vector2& to_map) {
  // Through the corner of a cell a leg and the same leg back may touch other cells: always walked one way.
  if (std::pair(to_map.x(), to_map.y()) < std::pair(from_map.x(), from_map.y()))
    return leg_cost(map, ground, to_map, from_map);
  const double length_m = (to_map - from_map).norm();
  const double pieces = std::max(1.0, std::ceil(length_m / (kPiece_cells * map.cell_size_m())));
  double price = 0;
  bool blocked = false;
  for (double i = 0; i < pieces && !blocked; ++i) {
    const Vector2 from = from_map + i / pieces * (to_map - from_map);
    const Vector2 to = i + 1 < pieces ? Vector2(from_map + (i + 1) / pieces * (to_map - from_map)) : to_map;
    std::uint32_t sum = 0, cells = 0;
    walk_ray(from, to, map.cell_size_m(), [&](CellIndex c) {
      const CoarseCell& coarse = map.coarse()[map.coarse().index_of(c)];
      const std::uint16_t here =
          map.contains(c) ? ground.price(coarse, map.clearance_steps(c)) : std::uint16_t{0};
      blocked = blocked || here == 0;
      sum += here;
      ++cells;
    });
    price += double(sum) / cells;
  }
  if (blocked) return std::nullopt;
  return length_m * price / (pieces * Ground::kUnit);
}

}  // namespace dynslam
