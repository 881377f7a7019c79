// SPDX-License-Identifier: MIT
#include "autopilot/frontier.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>

namespace dynslam {
namespace {

using Cells = std::vector<CellIndex>;  ///< row by row, unless said otherwise

/// Cells and the rectangle around them. Not empty.
struct Cluster {
  Cells cells;
  CellIndex low, high;

  explicit Cluster(CellIndex c) : low(c), high(c) {}
  void add(CellIndex c) {
    cells.push_back(c);
    include(c, c);
  }
  void include(CellIndex other_low, CellIndex other_high) {
    low = {std::min(low.x, other_low.x), std::min(low.y, other_low.y)};
    high = {std::max(high.x, other_high.x), std::max(high.y, other_high.y)};
  }
  int width() const { return high.x - low.x + 1; }
  int height() const { return high.y - low.y + 1; }
  double extent() const { return std::hypot(width(), height()); }
};

/// Sets of numbers that are joined to each other; each set goes by its least.
class JoinedSets {
 public:
  explicit JoinedSets(std::size_t n) : towards_(n) { std::iota(towards_.begin(), towards_.end(), 0U); }
  std::uint32_t least(std::size_t i) {
    while (towards_[i] != i) i = towards_[i] = towards_[towards_[i]];
    return static_cast<std::uint32_t>(i);
  }
  void join(std::size_t a, std::size_t b) {
    const std::uint32_t of_a = least(a), of_b = least(b);
    towards_[std::max(of_a, of_b)] = std::min(of_a, of_b);
  }

 private:
  std::vector<std::uint32_t> towards_;
};

bool comes_before(CellIndex a, CellIndex b) { return a.y != b.y ? a.y < b.y : a.x < b.x; }

/// Joins cells that touch each other, corners too. A second place in the list runs along one row below.
JoinedSets touching(std::span<const CellIndex> cells) {
  JoinedSets sets(cells.size());
  std::size_t below = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const CellIndex c = cells[i];
    if (i > 0 && cells[i - 1] == CellIndex{c.x - 1, c.y}) sets.join(i, i - 1);
    while (comes_before(cells[below], {c.x - 1, c.y - 1})) ++below;
    for (std::size_t j = below; !comes_before({c.x + 1, c.y - 1}, cells[j]); ++j) sets.join(i, j);
  }
  return sets;
}

std::vector<Cluster> components(std::span<const CellIndex> cells) {
  JoinedSets sets = touching(cells);
  std::vector<Cluster> found;
  std::vector<std::size_t> cluster_of(cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::size_t least = sets.least(i);
    if (least == i) {
      cluster_of[i] = found.size();
      found.emplace_back(cells[i]);
    }
    found[cluster_of[least]].add(cells[i]);
  }
  return found;
}

/// Equal parts across the longer side, as many as make each shorter than `most`.
std::vector<Cells> cut(const Cluster& cluster, double most) {
  const bool is_wide = cluster.width() >= cluster.height();
  const int length = is_wide ? cluster.width() : cluster.height();
  const int parts = static_cast<int>(std::ceil(cluster.extent() / most));
  std::vector<Cells> slices(static_cast<std::size_t>(parts));
  for (const CellIndex c : cluster.cells) {
    const std::int64_t along = is_wide ? c.x - cluster.low.x : c.y - cluster.low.y;
    slices[static_cast<std::size_t>(along * parts / length)].push_back(c);
  }
  return slices;
}

/// Components of no more than `most` cells from corner to corner.
std::vector<Cluster> places_of(std::span<const CellIndex> cells, double most) {
  std::vector<Cluster> places;
  std::vector<Cells> pending{{cells.begin(), cells.end()}};
  while (!pending.empty()) {
    const Cells part = std::move(pending.back());
    pending.pop_back();
    for (Cluster& cluster : components(part)) {
      if (cluster.extent() <= most) {
        places.push_back(std::move(cluster));
      } else {
        for (Cells& slice : cut(cluster, most)) pending.push_back(std::move(slice));
      }
    }
  }
  return places;
}

bool is_one_place(const Cluster& a, const Cluster& b, int gap, double most) {
  if (a.low.x - b.high.x > gap || b.low.x - a.high.x > gap) return false;
  if (a.low.y - b.high.y > gap || b.low.y - a.high.y > gap) return false;
  return std::hypot(std::max(a.high.x, b.high.x) - std::min(a.low.x, b.low.x) + 1,
                    std::max(a.high.y, b.high.y) - std::min(a.low.y, b.low.y) + 1) <= most;
}

/// Joins what is near to each other until nothing is. The cells are in no order after.
std::vector<Cluster> merged(std::vector<Cluster> pending, int gap, double most) {
  std::vector<Cluster> done;
  while (!pending.empty()) {
    Cluster cluster = std::move(pending.back());
    pending.pop_back();
    const auto near = std::find_if(done.begin(), done.end(),
                                   [&](const Cluster& d) { return is_one_place(d, cluster, gap, most); });
    if (near == done.end()) {
      done.push_back(std::move(cluster));
      continue;
    }
    near->cells.insert(near->cells.end(), cluster.cells.begin(), cluster.cells.end());
    near->include(cluster.low, cluster.high);
    std::swap(*near, done.back());
    pending.push_back(std::move(done.back()));
    done.pop_back();
  }
  return done;
}

CellIndex middle_of(const Cells& cells) {
  std::int64_t sum_x = 0, sum_y = 0;
  for (const CellIndex c : cells) sum_x += c.x, sum_y += c.y;
  const auto n = static_cast<double>(cells.size());
  const Vector2 mean{static_cast<double>(sum_x) / n, static_cast<double>(sum_y) / n};
  const auto rank = [&](CellIndex c) { return std::make_pair((Vector2(c.x, c.y) - mean).squaredNorm(), c); };
  return *std::min_element(cells.begin(), cells.end(),
                           [&](CellIndex a, CellIndex b) { return rank(a) < rank(b); });
}

}  // namespace

std::vector<Frontier> find_frontiers(std::span<const CellIndex> cells, double cell_size_m,
                                     const ExplorationConfig& config) {
  const double most = std::max(2.0, config.most_extent_m / cell_size_m);
  const int gap = static_cast<int>(config.merge_within_m / cell_size_m);
  std::vector<std::pair<CellIndex, Frontier>> found;
  for (const Cluster& c : merged(places_of(cells, most), gap, most)) {
    const double extent_m = c.extent() * cell_size_m;
    const double length_m = static_cast<double>(c.cells.size()) * cell_size_m;
    if (length_m < config.least_length_m - 1e-9 || extent_m < config.least_extent_m - 1e-9) continue;
    const CellIndex middle = middle_of(c.cells);
    found.push_back({middle, {cell_centre(middle, cell_size_m), extent_m, c.cells.size()}});
  }
  std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Frontier> frontiers;
  frontiers.reserve(found.size());
  for (const auto& [middle, frontier] : found) frontiers.push_back(frontier);
  return frontiers;
}

}  // namespace dynslam
