// SPDX-License-Identifier: MIT
#include "robot/replay.h"

#include <chrono>
#include <ctime>
#include <utility>

#include "slam/slam.h"

namespace dynslam {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_between(Clock::time_point a, Clock::time_point b) {
  return std::chrono::duration<double>(b - a).count();
}

double cpu_seconds() {
  std::timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// Measures the stages of each scan, and each scan as the sum of its stages.
class StageClock : public StageWatch {
 public:
  void enter(std::string_view stage) override {
    const Clock::time_point now = Clock::now();
    if (!stage_.empty()) total_s_[stage_] += seconds_between(since_, now);
    if (stage_.empty()) begun_ = now;
    if (stage.empty()) scan_ms_.push_back(static_cast<float>(1e3 * seconds_between(begun_, now)));
    stage_ = stage;
    since_ = now;
  }

  std::vector<float> take_scan_ms() { return std::move(scan_ms_); }
  std::map<std::string, double> mean_ms(std::size_t scans) const {
    std::map<std::string, double> mean;
    for (const auto& [stage, s] : total_s_) mean[std::string(stage)] = 1e3 * s / static_cast<double>(scans);
    return mean;
  }

 private:
  std::string_view stage_;
  Clock::time_point since_, begun_;
  std::map<std::string_view, double> total_s_;
  std::vector<float> scan_ms_;
};

std::vector<StampedPose> poses_of(const Slam& slam) {
  std::vector<StampedPose> poses;
  for (const StampedFix& fix : slam.trajectory()) poses.push_back({fix.stamp, fix.map_T_robot});
  return poses;
}

/// Works off what is ready and notes it.
void work_off(Slam& slam, bool at_end, const ReplayFrames& frames, ReplayResult& result) {
  while (const auto scan = slam.next(at_end)) {
    result.trajectory_live.push_back({scan->stamp, scan->map_T_robot});
    result.inserted += scan->inserted ? 1 : 0;
    const std::uint64_t scans = result.trajectory_live.size();
    if (frames.every > 0 && scans % frames.every == 0)
      frames.show(scans, slam.global_map().snapshot(), poses_of(slam));
  }
}

PicturedEdge::Kind kind_of(EdgeKind kind) {
  switch (kind) {
    case EdgeKind::kLoop:
      return PicturedEdge::Kind::kLoop;
    case EdgeKind::kTurn:
      return PicturedEdge::Kind::kTurn;
    default:
      return PicturedEdge::Kind::kOdometry;
  }
}

GraphPicture picture_of(const BackEnd& back_end) {
  GraphPicture picture;
  for (const GraphNode& node : back_end.graph().nodes())
    picture.maps.push_back({node.id, node.map_T_node, true});
  for (const std::uint32_t id : back_end.retired())
    picture.maps.push_back({id, back_end.map_T_origin(id), false});
  for (const GraphEdge& e : back_end.graph().edges())
    picture.edges.push_back({kind_of(e.kind), e.a, e.b, e.residual});
  for (const RefusedLoop& r : back_end.loops().refused())
    picture.refused.push_back({r.a, r.b, r.a_T_b, r.reason});
  for (const RefusedLoop& r : back_end.loops().let_go())
    picture.let_go.push_back({r.a, r.b, r.a_T_b, r.reason});
  return picture;
}

}  // namespace

ReplayResult replay(Recording& recording, const SlamConfig& config, const ReplayProgress& progress,
                    const ReplayFrames& frames) {
  const Clock::time_point begun = Clock::now();
  const double cpu_before = cpu_seconds();
  ReplayResult result;
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

  result.trajectory = poses_of(slam);
  result.graph = picture_of(slam.back_end());
  result.loop_closures = slam.back_end().loops().closures();
  result.map = slam.global_map().snapshot();
  result.map_bytes = slam.global_map().bytes();
  result.local_maps = slam.local_maps_begun();
  result.local_maps_active = slam.local_maps_active();
  result.stages_ms = watch.mean_ms(std::max<std::size_t>(1, result.trajectory.size()));
  result.scan_ms = watch.take_scan_ms();
  result.findings = slam.findings();
  result.counters = slam.counters();
  for (const auto& [name, n] : recording.counters()) result.counters.add(name, n);
  result.wall_s = seconds_between(begun, Clock::now());
  result.cpu_s = cpu_seconds() - cpu_before;
  return result;
}

}  // namespace dynslam
