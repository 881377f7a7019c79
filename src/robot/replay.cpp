// SPDX-License-Identifier: MIT
#include "robot/replay.h"

#include <algorithm>
#include <utility>

#include "robot/stage_clock.h"
#include "slam/slam.h"

namespace dynslam {
namespace {

/// Works off what is ready and notes it.
void work_off(Slam& slam, bool at_end, const ReplayFrames& frames, MappingResult& result) {
  while (const auto scan = slam.next(at_end)) {
    result.trajectory_live.push_back({scan->stamp, scan->map_T_robot});
    result.inserted += scan->inserted ? 1 : 0;
    const std::uint64_t scans = result.trajectory_live.size();
    if (frames.every > 0 && scans % frames.every == 0)
      frames.show(scans, slam.global_map().snapshot(), poses_of(slam));
  }
}

}  // namespace

MappingResult replay(Recording& recording, const SlamConfig& config, const ReplayProgress& progress,
                     const ReplayFrames& frames) {
  const WorkTimer timer;
  MappingResult result;
  StageClock watch;
  Slam slam(config, &watch);
  if (frames.every > 0) slam.follow();
  std::uint64_t records = 0;
  while (auto record = recording.next()) {
    std::visit([&](auto&& sample) { slam.add(std::forward<decltype(sample)>(sample)); }, std::move(*record));
    work_off(slam, false, frames, result);
    if (++records % 64 == 0) progress(recording.progress(), result.trajectory_live.size());
  }
  work_off(slam, true, frames, result);
  slam.finish();
  progress(1.0, result.trajectory_live.size());

  take_result(slam, result);
  result.stages_ms = watch.mean_ms(std::max<std::size_t>(1, result.trajectory.size()));
  result.scan_ms = watch.take_scan_ms();
  result.counters = slam.counters();
  for (const auto& [name, n] : recording.counters()) result.counters.add(name, n);
  result.wall_s = timer.wall_s();
  result.cpu_s = timer.cpu_s();
  return result;
}

}  // namespace dynslam
