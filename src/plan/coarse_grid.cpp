// SPDX-License-Identifier: MIT
#include "plan/coarse_grid.h"

#include <algorithm>
#include <utility>

namespace dynslam {

void CoarseGrid::cover(const ChunkBox& box) {
  const CoarseGrid old = std::move(*this);
  box_ = box;
  first_ = {box.min.x * kCoarseOfChunk - kRim, box.min.y * kCoarseOfChunk - kRim};
  stride_ = box.width() * kCoarseOfChunk + 2 * kRim;
  cells_.assign(
      static_cast<std::size_t>(stride_) * static_cast<std::size_t>(box.height() * kCoarseOfChunk + 2 * kRim),
      {});
  const ChunkIndex low{std::max(box.min.x, old.box_.min.x), std::max(box.min.y, old.box_.min.y)};
  const ChunkIndex high{std::min(box.max.x, old.box_.max.x), std::min(box.max.y, old.box_.max.y)};
  if (low.x > high.x) return;
  const CellIndex from = first_cell(low);
  for (int y = from.y; y < (high.y + 1) * kChunkSide; y += kCoarseSide) {
    const auto source = old.cells_.begin() + static_cast<std::ptrdiff_t>(old.index_of({from.x, y}));
    std::copy_n(source, (high.x - low.x + 1) * kCoarseOfChunk,
                cells_.begin() + static_cast<std::ptrdiff_t>(index_of({from.x, y})));
  }
}

}  // namespace dynslam
