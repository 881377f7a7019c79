// SPDX-License-Identifier: MIT
#include "plan/coarse_search.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

namespace dynslam {
namespace {

/// Eight neighbours, counter-clockwise from the right; then the knight's moves, number 8 + k between
/// neighbours k and k + 1.
constexpr std::array<int, 16> kDx = {1, 1, 0, -1, -1, -1, 0, 1, 2, 1, -1, -2, -2, -1, 1, 2};
constexpr std::array<int, 16> kDy = {0, 1, 1, 1, 0, -1, -1, -1, 1, 2, 2, 1, -1, -2, -2, -1};
constexpr std::uint32_t kStraight = CoarseSearch::kStep, kDiagonal = 181, kLong = 286;
constexpr std::size_t kNone = 255;
/// Ways as dear as that are not followed: the sum must not overflow.
constexpr std::uint32_t kDearest = 1U << 31;

constexpr std::size_t kind_of(std::size_t direction) { return direction >= 8 ? 2 : direction % 2; }
constexpr std::array<std::uint32_t, 3> kLengths = {kStraight, kDiagonal, kLong};

/// With so much room at both ends of a step no cell that it touches has less than `least_m`, wherever in the
/// coarse cells it begins and ends: what is blocked lies outside of two circles.
double sure_clearance_m(double least_m, double cell_size_m, int dx, int dy) {
  const double longest_m = cell_size_m * std::hypot(kCoarseSide * (dx + 1) - 1, kCoarseSide * (dy + 1) - 1);
  const double off_the_line_m = cell_size_m / std::numbers::sqrt2;
  return std::hypot(least_m + off_the_line_m + kClearanceStep_m, 0.5 * longest_m);
}

}  // namespace

void CoarseSearch::begin(const Costmap& map, const Ground& cells, const Ground& legs, std::size_t from,
                         std::optional<std::size_t> aim) {
  map_ = &map;
  cells_ = &cells;
  legs_ = &legs;
  stride_ = map.coarse().stride();
  aim_.reset();
  if (aim) aim_ = place_of(*aim);
  for (std::size_t d = 0; d < offsets_.size(); ++d) offsets_[d] = kDy[d] * std::ptrdiff_t{stride_} + kDx[d];
  const double least_m = legs.least_clearance() * kClearanceStep_m;
  for (const std::size_t d : {0U, 1U, 8U}) {
    const double sure_m = sure_clearance_m(least_m, map.cell_size_m(), kDx[d], kDy[d]);
    // Of what is farther away than the reach nothing is known but that.
    sure_clearance_[kind_of(d)] = clearance_steps_for(sure_m);
  }
  if (nodes_.size() != map.coarse().size() || ++stamp_ == 0) {
    nodes_.assign(map.coarse().size(), {});
    stamp_ = 1;
  }
  queue_.clear();
  aside_.clear();
  joining_.clear();
  nodes_[from] = {0, stamp_, kNone};
  queue_.push(estimate_from(place_of(from)), {static_cast<std::uint32_t>(from), 0});
}

std::optional<CoarseSearch::Settled> CoarseSearch::next() {
  while (true) {
    let_join();
    const auto entry = queue_.pop();
    if (!entry) return std::nullopt;
    if (nodes_[entry->index].cost != entry->cost) continue;  // a cheaper way there was found since
    return Settled{entry->index, entry->cost, entry->cost + estimate_from(place_of(entry->index))};
  }
}

void CoarseSearch::take_up() {
  joining_.insert(joining_.end(), aside_.begin(), aside_.end());
  aside_.clear();
  std::sort(joining_.begin(), joining_.end(),
            [](const Settled& a, const Settled& b) { return a.estimate > b.estimate; });
}

void CoarseSearch::let_join() {
  if (joining_.empty()) return;
  if (queue_.empty()) queue_.clear();
  while (!joining_.empty() && queue_.takes(joining_.back().estimate)) {
    const Settled& next = joining_.back();
    queue_.push(next.estimate, {static_cast<std::uint32_t>(next.index), next.cost});
    joining_.pop_back();
  }
}

void CoarseSearch::expand(const Settled& settled) {
  const CoarseGrid& grid = map_->coarse();
  const Place place = place_of(settled.index);
  const std::uint8_t room = grid[settled.index].clearance;
  std::array<bool, 9> open;
  for (std::size_t d = 0; d < 8; ++d) {
    const auto to = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(settled.index) + offsets_[d]);
    open[d] = cells_->price(grid[to]) != 0;
  }
  open[8] = open[0];
  const auto has_room = [&](std::size_t d) {
    const auto to = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(settled.index) + offsets_[d]);
    return std::min(room, grid[to].clearance) >= sure_clearance_[kind_of(d)];
  };
  for (std::size_t d = 0; d < 8; ++d) {
    const bool beside = d % 2 == 0 || (open[d - 1] && open[d + 1]);
    if (open[d]) offer(settled, place, d, beside && has_room(d));
    if (open[d] && open[d + 1]) offer(settled, place, d + 8, has_room(d + 8));
  }
}

void CoarseSearch::offer(const Settled& from, Place from_place, std::size_t direction, bool sure) {
  const CoarseGrid& grid = map_->coarse();
  const auto to = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(from.index) + offsets_[direction]);
  const std::uint32_t price = cells_->price(grid[to]);
  if (price == 0) return;
  const std::uint32_t prices = price + cells_->price(grid[from.index]);
  const std::uint32_t cost = from.cost + kLengths[kind_of(direction)] * prices / (2 * Ground::kUnit);
  Node& node = nodes_[to];
  if ((node.stamp == stamp_ && node.cost <= cost) || cost > kDearest) return;
  if (!sure && !is_clear(from.index, to)) return;
  node = {cost, stamp_, static_cast<std::uint8_t>(direction)};
  const Place place{from_place.x + kDx[direction], from_place.y + kDy[direction]};
  queue_.push(cost + estimate_from(place), {static_cast<std::uint32_t>(to), cost});
}

bool CoarseSearch::is_clear(std::size_t from, std::size_t to) const {
  const auto centre = [this](std::size_t index) {
    return cell_centre(map_->coarse().best_cell(index), map_->cell_size_m());
  };
  return leg_cost(*map_, *legs_, centre(from), centre(to)).has_value();
}

CoarseSearch::Place CoarseSearch::place_of(std::size_t index) const {
  const auto i = static_cast<std::uint32_t>(index), stride = static_cast<std::uint32_t>(stride_);
  return {static_cast<int>(i % stride), static_cast<int>(i / stride)};
}

/// What the way to the aim costs where nothing is in it; exact for the 16 directions.
std::uint32_t CoarseSearch::estimate_from(Place place) const {
  if (!aim_) return 0;
  const auto dx = static_cast<std::uint32_t>(std::abs(place.x - aim_->x));
  const auto dy = static_cast<std::uint32_t>(std::abs(place.y - aim_->y));
  const std::uint32_t more = std::max(dx, dy), less = std::min(dx, dy);
  if (2 * less <= more) return less * kLong + (more - 2 * less) * kStraight;
  return (more - less) * kLong + (2 * less - more) * kDiagonal;
}

std::size_t CoarseSearch::before(std::size_t index) const {
  const std::uint8_t direction = nodes_[index].direction;
  if (direction == kNone) return index;
  return static_cast<std::size_t>(static_cast<std::ptrdiff_t>(index) - offsets_[direction]);
}

double CoarseSearch::last_step(std::size_t index) const {
  const std::uint8_t direction = nodes_[index].direction;
  return direction == kNone ? 0.0 : std::hypot(kDx[direction], kDy[direction]);
}

}  // namespace dynslam
