// SPDX-License-Identifier: MIT
#pragma once

#include "grid/chunk.h"

namespace dynslam {

/// Which cells of a chunk are occupied, and which are not unknown.
struct CellStates {
  CellTile occupied{};
  CellTile known{};
};

CellStates states_of(const Chunk& chunk);

}  // namespace dynslam
