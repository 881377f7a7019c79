// SPDX-License-Identifier: MIT
#include "slam/global_map.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace dynslam {
namespace {

constexpr double kTile_m = 0.25;
constexpr int kWall = 2;  ///< cells: an older surface this near to a newer one is the same

enum class Word : std::uint8_t { kSilent, kFree, kOccupied, kNoWall };

/// A finished map where it is, ready to be asked cell by cell.
struct Witness {
  const FinishedMap* map;
  const CellBitmap* near_surface;
  double c, s, x, y;  ///< from map cells to cells the map was drawn in

  Witness(const FinishedMap& m, const CellBitmap& near, const Pose2& map_T_origin)
      : map(&m), near_surface(&near) {
    const Pose2 drawn_T_map = m.drawn_T_origin * map_T_origin.inverse();
    c = std::cos(drawn_T_map.yaw), s = std::sin(drawn_T_map.yaw);
    x = drawn_T_map.x / m.cell_size_m, y = drawn_T_map.y / m.cell_size_m;
  }

  CellIndex cell(double map_x, double map_y) const {
    return {static_cast<std::int32_t>(std::floor(x + c * map_x - s * map_y)),
            static_cast<std::int32_t>(std::floor(y + s * map_x + c * map_y))};
  }

  /// What the map says of the cell with this centre (in cells). A line one cell thick falls between the
  /// centres of a turned grid, so surfaces are looked for at four places in the cell.
  Word say(double centre_x, double centre_y) const {
    for (const auto& [dx, dy] : {std::pair{-0.25, -0.25}, {0.25, -0.25}, {-0.25, 0.25}, {0.25, 0.25}}) {
      if (map->occupied.test(cell(centre_x + dx, centre_y + dy))) return Word::kOccupied;
    }
    const CellIndex middle = cell(centre_x, centre_y);
    if (map->free.test(middle)) return Word::kFree;
    return near_surface->test(middle) ? Word::kNoWall : Word::kSilent;
  }
};

CellState hear(const std::vector<Witness>& newest_first, double x, double y) {
  bool no_wall = false;
  for (const Witness& w : newest_first) {
    const Word word = w.say(x, y);
    if (word == Word::kFree) return CellState::kFree;
    if (word == Word::kOccupied && !no_wall) return CellState::kOccupied;
    no_wall = no_wall || word != Word::kSilent;
  }
  return CellState::kUnknown;
}

/// Cells of a row or column of blocks: those whose centres lie in it.
std::pair<std::int32_t, std::int32_t> cells_of_block(std::int32_t block, double cell_size_m) {
  const auto first = [&](std::int32_t b) {
    return static_cast<std::int32_t>(std::ceil(b * GlobalMap::kBlock_m / cell_size_m - 0.5));
  };
  return {first(block), first(block + 1)};
}

}  // namespace

void GlobalMap::place(std::shared_ptr<const FinishedMap> map, const Pose2& map_T_origin) {
  const std::uint32_t id = map->id;
  auto near = std::make_shared<const CellBitmap>(map->occupied.grown(kWall));
  std::vector<Tile> tiles = tiles_of(*map);
  Placed& placed = maps_[id] = {std::move(map), std::move(near), std::move(tiles), map_T_origin, {}};
  cover(id, placed);
}

void GlobalMap::move(const std::map<std::uint32_t, Pose2>& map_T_origins) {
  const double least_m = 0.1 * grid_.cell_size_m();
  bool any = false;
  for (auto& [id, placed] : maps_) {
    const auto to = map_T_origins.find(id);
    if (to == map_T_origins.end()) continue;
    const Pose2 step = placed.map_T_origin.inverse() * to->second;
    // A turn moves what is five metres away the most that matters.
    if (step.translation().norm() + 5.0 * std::abs(step.yaw) < least_m) continue;
    uncover(placed);
    placed.map_T_origin = to->second;
    any = true;
  }
  if (any) rebuild_history();
}

void GlobalMap::remove(std::uint32_t id) {
  const auto it = maps_.find(id);
  if (it == maps_.end()) return;
  uncover(it->second);
  maps_.erase(it);
  rebuild_history();
}

std::vector<GlobalMap::Tile> GlobalMap::tiles_of(const FinishedMap& map) {
  const int side = std::max(1, static_cast<int>(std::lround(kTile_m / map.cell_size_m)));
  const CellIndex first = map.free.first();
  const int columns = (map.free.words_per_row() * kChunkSide + side - 1) / side;
  std::vector<int> known(static_cast<std::size_t>(columns) *
                         static_cast<std::size_t>((map.free.rows() + side - 1) / side));
  for (int y = 0; y < map.free.rows(); ++y) {
    for (int w = 0; w < map.free.words_per_row(); ++w) {
      for (std::uint64_t bits = map.free.row(y)[w] | map.occupied.row(y)[w]; bits != 0; bits &= bits - 1) {
        const int x = w * kChunkSide + std::countr_zero(bits);
        ++known[static_cast<std::size_t>(y / side * columns + x / side)];
      }
    }
  }
  std::vector<Tile> tiles;
  for (std::size_t i = 0; i < known.size(); ++i) {
    if (known[i] == 0) continue;
    const double x = (static_cast<double>(i % static_cast<std::size_t>(columns)) + 0.5) * side;
    const double y = (static_cast<double>(i / static_cast<std::size_t>(columns)) + 0.5) * side;
    tiles.push_back({Vector2((first.x + x) * map.cell_size_m, (first.y + y) * map.cell_size_m), known[i]});
  }
  return tiles;
}

/// Adds up how much of each block a map knows where it is now. A tile counts for the block that its centre
/// lies in; the blocks that its corners lie in have to be drawn from it too.
void GlobalMap::cover(std::uint32_t id, Placed& placed) {
  constexpr double kAtAll = 1e-3;
  const double cell_share = std::pow(placed.map->cell_size_m / kBlock_m, 2);
  const Pose2 map_T_drawn = placed.map_T_origin * placed.map->drawn_T_origin.inverse();
  const double half = 0.75 * kTile_m;  // to a corner, and some for the turn
  for (const Tile& tile : placed.tiles) {
    const Vector2 centre = map_T_drawn * tile.centre_drawn;
    placed.shares[cell_at(centre, kBlock_m)] += tile.known * cell_share;
    for (const auto& [dx, dy] : {std::pair{-half, -half}, {half, -half}, {-half, half}, {half, half}}) {
      placed.shares[cell_at(centre + Vector2(dx, dy), kBlock_m)] += kAtAll;
    }
  }
  for (const auto& [block, share] : placed.shares) {
    history_.cover(block, id, share);
    dirty_.insert(block);
  }
}

void GlobalMap::uncover(Placed& placed) {
  for (const auto& [block, share] : placed.shares) dirty_.insert(block);
  placed.shares.clear();
}

void GlobalMap::rebuild_history() {
  history_.clear();
  for (auto& [id, placed] : maps_) {
    if (placed.shares.empty()) {
      cover(id, placed);
    } else {
      for (const auto& [block, share] : placed.shares) history_.cover(block, id, share);
    }
  }
}

std::size_t GlobalMap::redraw(std::size_t most_blocks) {
  for (; most_blocks > 0 && !dirty_.empty(); --most_blocks) {
    draw(*dirty_.begin());
    dirty_.erase(dirty_.begin());
  }
  return dirty_.size();
}

void GlobalMap::draw(CellIndex block) {
  std::vector<Witness> newest_first;
  for (const std::uint32_t id : history_.maps_at(block)) {
    const auto it = maps_.find(id);
    if (it != maps_.end())
      newest_first.emplace_back(*it->second.map, *it->second.near_surface, it->second.map_T_origin);
  }
  const auto [left, right] = cells_of_block(block.x, grid_.cell_size_m());
  const auto [low, high] = cells_of_block(block.y, grid_.cell_size_m());
  for (std::int32_t y = low; y < high; ++y) {
    for (std::int32_t x = left; x < right; ++x) grid_.set({x, y}, hear(newest_first, x + 0.5, y + 0.5));
  }
}

std::vector<std::uint32_t> GlobalMap::retire(std::uint32_t keep) {
  const std::set<std::uint32_t> named = history_.named();
  std::vector<std::uint32_t> retired;
  for (auto it = maps_.begin(); it != maps_.end();) {
    if (it->first >= keep || named.contains(it->first)) {
      ++it;
    } else {
      retired.push_back(it->first);
      it = maps_.erase(it);
    }
  }
  return retired;
}

}  // namespace dynslam
