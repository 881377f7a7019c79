// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <unordered_map>
#include <vector>

#include "base/pose2.h"
#include "base/time.h"
#include "grid/tiled_bitmap.h"
#include "slam/finished_map.h"

namespace dynslam {

/// What a chunk of the global map shows.
struct DrawnChunk {
  ChunkIndex index;
  CellTile free{};
  CellTile occupied{};  ///< never also free
};

/// The map of everything, drawn from finished local maps where the pose graph has put them (thesis 4.1.5).
///
/// Each cell shows what the newest local map that knows it says. A map that is silent about a cell leaves
/// what older ones said, except right beside its own surfaces: an older wall drawn a cell or two behind a
/// newer one is the same wall. (Past the newer one's end it goes on.) What lies right behind newer walls,
/// where no one can see it any more, is dropped.
///
/// The history map is kept in blocks of about half a metre. Each names the maps that show in it, newest
/// first; drawing it takes out the names of those that do not. A map that no block names is not needed.
/// The thesis names the newest map that covers 75 % of a block, and loses the rest of what older ones saw
/// there (its figure 5.3); naming by what shows loses nothing, and is bounded all the same, as each name has
/// to show a fiftieth of the block that no newer one does.
///
/// Work is counted in blocks: only those that changed are drawn again, as many a turn as the caller allows.
/// One thread.
class GlobalMap {
 public:
  explicit GlobalMap(double cell_size_m);

  /// Puts in a map that is newer than all others.
  void place(std::shared_ptr<const FinishedMap> map, const Pose2& map_T_origin);
  /// The same for a map that will be taken out again: it takes no names from others.
  void place_for_now(std::shared_ptr<const FinishedMap> map, const Pose2& map_T_origin);
  /// Puts the maps that the pose graph moved where they belong now. Moves of less than a fourth of a cell
  /// are waited for.
  void move(const std::map<std::uint32_t, Pose2>& map_T_origins);
  /// Takes a map out as if it had never been.
  void remove(std::uint32_t id);

  /// Draws up to `most_blocks` of the blocks that changed, those first that wait longest; returns how many
  /// are left.
  std::size_t redraw(std::size_t most_blocks);

  /// Drops what cannot be seen and returns the chunks that look different from when this was called last.
  /// Linear in the rectangle of the building, a few ms for 40 x 40 m at 2 cm.
  std::vector<DrawnChunk> publish();

  /// Maps that no block needs any more; they are taken out. `keep` and newer ones stay in any case.
  std::vector<std::uint32_t> retire(std::uint32_t keep);

  std::size_t active() const { return maps_.size(); }
  std::size_t waiting_blocks() const { return dirty_.size(); }
  /// When the place around a cell was seen last: the end of the newest map that shows there.
  std::optional<Time> last_seen(CellIndex cell) const;
  /// Side of a block: a power of two, so that blocks fill chunks.
  int block_cells() const { return 1 << block_bits_; }
  /// How many maps are named in how many blocks, for those who watch memory.
  std::size_t blocks() const { return blocks_.size(); }
  std::size_t names() const;

 private:
  struct Block {
    std::vector<std::uint32_t> ids;  ///< of the maps that show in it, newest first
    bool dirty = false;
  };
  struct HashOfBlock {
    std::size_t operator()(CellIndex b) const {
      const auto x = static_cast<std::uint32_t>(b.x), y = static_cast<std::uint32_t>(b.y);
      return (std::uint64_t{y} << 32 | x) * 0x9E3779B97F4A7C15ULL >> 32;
    }
  };
  using BlockSet = std::vector<CellIndex>;  ///< in order, each once
  struct Placed {
    std::shared_ptr<const FinishedMap> map;
    Pose2 map_T_origin;
    BlockSet blocks;  ///< that name it
  };
  struct Picture {
    DrawnChunk drawn;  ///< as it was drawn
    DrawnChunk shown;  ///< as it was published
  };
  void name(CellIndex block, std::uint32_t id);
  void unname(CellIndex block, std::uint32_t id);
  void name_in(std::uint32_t id, Placed& placed, BlockSet blocks);
  void touch(CellIndex index, Block& block);
  void append_under_square(const Vector2& centre_cells, double half_width_cells, BlockSet& blocks) const;
  BlockSet blocks_under(const Placed& placed) const;
  void move_to(std::uint32_t id, Placed& placed, const Pose2& map_T_origin);
  void draw(CellIndex index, Block& block);
  ChunkBox box() const;

  double cell_size_m_;
  int block_bits_;
  std::optional<std::uint32_t> passing_;  ///< placed for now
  std::map<std::uint32_t, Placed> maps_;
  std::unordered_map<CellIndex, Block, HashOfBlock> blocks_;
  std::deque<CellIndex> dirty_;
  std::map<ChunkIndex, Picture> pictures_;
};

}  // namespace dynslam
