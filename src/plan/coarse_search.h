// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "plan/bucket_queue.h"
#include "plan/ground.h"

namespace dynslam {

/// A* (or, without an aim, Dijkstra's wave) over the coarse cells, 16 neighbours each. A coarse cell stands
/// for its roomiest cell. Where the room around two neighbours does not say that the leg between them is
/// free, it is looked at in full resolution; so every step keeps the clearance of `legs`.
///
/// Costs are whole numbers, a coarse cell of easy ground is kStep. The state is kept from one search to the
/// next, and told apart by a stamp.
class CoarseSearch {
 public:
  static constexpr std::uint32_t kStep = 128;

  struct Settled {
    std::size_t index;
    std::uint32_t cost;
    std::uint32_t estimate;  ///< of the whole way through here
  };

  /// Begins anew. All three must live and stay as they are until the last step. REQUIRES: `from` and `aim`
  /// are indices of coarse cells in the map's box.
  void begin(const Costmap& map, const Ground& cells, const Ground& legs, std::size_t from,
             std::optional<std::size_t> aim);
  /// The next cell in order of its estimate; a cell may come again, cheaper.
  std::optional<Settled> next();
  /// Goes on from there.
  void expand(const Settled& settled);
  /// Instead of going on from there now: after take_up() it comes once more, in its turn.
  void put_aside(const Settled& settled) { aside_.push_back(settled); }
  void take_up();

  /// Whether the search came by there.
  bool reached(std::size_t index) const { return nodes_[index].stamp == stamp_; }
  /// Where the way to a settled cell comes from; itself for the first.
  std::size_t before(std::size_t index) const;
  /// The length of the step to a settled cell, in coarse cells.
  double last_step(std::size_t index) const;

 private:
  struct Node {
    std::uint32_t cost = 0;
    std::uint16_t stamp = 0;
    std::uint8_t direction = 0;
  };
  struct Entry {
    std::uint32_t index, cost;
  };
  struct Place {
    int x, y;
  };
  Place place_of(std::size_t index) const;
  std::uint32_t estimate_from(Place place) const;
  bool is_clear(std::size_t from, std::size_t to) const;
  void let_join();
  void offer(const Settled& from, Place from_place, std::size_t direction, bool sure);

  const Costmap* map_ = nullptr;
  const Ground* cells_ = nullptr;
  const Ground* legs_ = nullptr;
  std::optional<Place> aim_;
  std::array<std::ptrdiff_t, 16> offsets_{};
  std::array<std::uint8_t, 3> sure_clearance_{};  ///< of straight, diagonal and long steps
  std::vector<Node> nodes_;
  std::uint16_t stamp_ = 0;
  int stride_ = 0;
  /// A quarter of a step wide: within it the order does not matter much.
  BucketQueue<Entry, kStep / 4, 1024> queue_;
  std::vector<Settled> aside_;
  std::vector<Settled> joining_;  ///< taken up, the cheapest last; as soon as the queue takes it
};

}  // namespace dynslam
