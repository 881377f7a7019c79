// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/pose2.h"
#include "grid/chunked_grid.h"
#include "io/recording.h"
#include "slam/passes.h"

namespace dynslam::bench {

/// Where the scans of a benchmark come from.
struct ScanSource {
  std::string name;  ///< as in the names of the benchmarks
  std::string path;  ///< of a recording; empty: the drawn room
};

/// The real recording of 361 beams, and one of more beams: the drawn room, or what DYNSLAM_BENCH_RECORDING
/// names.
const std::vector<ScanSource>& scan_sources();
/// The real one.
const ScanSource& real_source();

/// Throws InputError when there is no such recording.
std::unique_ptr<Recording> open_source(const ScanSource& source);

/// Scans as they are drawn and matched, with the robot's poses at their reference times as SLAM found them.
struct ScanSequence {
  std::vector<CorrectedScan> scans;
  std::vector<Pose2> map_T_robot;
};

/// The first of a source's scans, up to a bound that keeps memory small. Computed once.
/// Throws InputError when there are too few.
const ScanSequence& sequence_of(const ScanSource& source);

/// Scans in a row that make about half a local map, and one more to match against it.
inline constexpr std::size_t kStretchScans = 26;
/// Where in the sequence stretches begin: a few, spread evenly.
std::vector<std::size_t> stretches_of(const ScanSequence& sequence);

/// How far apart beams may be for what lies between them to count as seen: as Slam has it.
double max_wedge_rad(const CorrectedScan& scan);

/// Draws a number of scans from `begin` on, as a local map has them drawn.
void draw(const ScanSequence& sequence, std::size_t begin, std::size_t count, ChunkedGrid& grid);

/// Cell sizes that everything is measured at.
struct CellSize {
  const char* name;
  double metres;
};
inline constexpr CellSize kCellSizes[] = {{"2cm", 0.02}, {"5cm", 0.05}};

/// Calls `make(name, source, cell)` for each source and cell size; `name` is "WHAT/SOURCE/CELL".
template <class Make>
void for_each_case(const std::string& what, Make&& make) {
  for (const ScanSource& source : scan_sources()) {
    for (const CellSize& cell : kCellSizes)
      make(what + "/" + source.name + "/" + cell.name, source, cell.metres);
  }
}

}  // namespace dynslam::bench
