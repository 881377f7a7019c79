// SPDX-License-Identifier: MIT
#include "bench/scan_source.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <utility>

#include "base/error.h"
#include "bench/drawn_room.h"
#include "grid/free_space.h"
#include "io/trajectory.h"
#include "slam/slam.h"

namespace dynslam::bench {
namespace {

constexpr std::size_t kMostScans = 2000;
constexpr std::size_t kStretches = 8;

std::vector<ScanSource> make_sources() {
  std::vector<ScanSource> sources = {{"csail_361_real", DYNSLAM_SOURCE_DIR "/tests/data/mit-csail.clf.gz"}};
  const char* other = std::getenv("DYNSLAM_BENCH_RECORDING");
  if (other && *other) {
    sources.push_back({std::filesystem::path(other).stem().string(), other});
  } else {
    sources.push_back({"room_1200_drawn", ""});
  }
  return sources;
}

/// What SLAM makes of a recording's first scans.
struct Solved {
  std::vector<Scan> scans;
  std::vector<StampedPose> track;
};

Solved solve(Recording& recording) {
  Solved out;
  SlamConfig config;
  config.close_loops = false;  // poses are to be continuous
  Slam slam(config);
  const auto work_off = [&](bool at_end) {
    while (const auto r = slam.next(at_end)) out.track.push_back({r->stamp, r->map_T_robot});
  };
  while (auto record = recording.next()) {
    if (const Scan* scan = std::get_if<Scan>(&*record)) {
      if (out.scans.size() == kMostScans) break;
      out.scans.push_back(*scan);
    }
    std::visit([&](auto&& sample) { slam.add(std::forward<decltype(sample)>(sample)); }, std::move(*record));
    work_off(false);
  }
  work_off(true);
  // A clock that was set back would leave stamps out of order; here any order that is one will do.
  std::stable_sort(out.track.begin(), out.track.end(),
                   [](const auto& a, const auto& b) { return a.stamp < b.stamp; });
  return out;
}

/// REQUIRES: `track` is not empty. Before its first pose and after its last the robot stands.
Pose2 pose_at(const std::vector<StampedPose>& track, Time t) {
  const auto later =
      std::partition_point(track.begin(), track.end(), [&](const StampedPose& p) { return p.stamp <= t; });
  if (later == track.begin()) return track.front().map_T_robot;
  if (later == track.end()) return track.back().map_T_robot;
  const StampedPose &a = *std::prev(later), &b = *later;
  return interpolate(a.map_T_robot, b.map_T_robot, to_seconds(t - a.stamp) / to_seconds(b.stamp - a.stamp));
}

ScanSequence make_sequence(const ScanSource& source) {
  const Solved solved = solve(*open_source(source));
  ScanSequence sequence;
  if (solved.track.size() < kStretchScans) throw InputError(source.path + ": too few scans to measure with");
  for (const Scan& scan : solved.scans) {
    const Pose2 at = pose_at(solved.track, reference_time(scan));
    const auto motion = [&](Time t) { return at.inverse() * pose_at(solved.track, t); };
    CorrectedScan corrected = egomotion_pass(scan, clamp_pass(scan, {}), motion);
    stray_ray_pass(corrected);
    sequence.scans.push_back(std::move(corrected));
    sequence.map_T_robot.push_back(at);
  }
  return sequence;
}

}  // namespace

const std::vector<ScanSource>& scan_sources() {
  static const std::vector<ScanSource> sources = make_sources();
  return sources;
}

const ScanSource& real_source() { return scan_sources().front(); }

std::unique_ptr<Recording> open_source(const ScanSource& source) {
  return source.path.empty() ? open_drawn_room() : open_recording(source.path);
}

const ScanSequence& sequence_of(const ScanSource& source) {
  static std::map<std::string, ScanSequence> known;
  const auto it = known.find(source.name);
  return it != known.end() ? it->second : known.emplace(source.name, make_sequence(source)).first->second;
}

std::vector<std::size_t> stretches_of(const ScanSequence& sequence) {
  std::vector<std::size_t> begins;
  const std::size_t room = sequence.scans.size() - kStretchScans;
  for (std::size_t i = 0; i < kStretches; ++i) begins.push_back(i * room / (kStretches - 1));
  return begins;
}

double max_wedge_rad(const CorrectedScan& scan) { return std::min(2.5 * scan.beam_step_rad, radians(5.0)); }

void draw(const ScanSequence& sequence, std::size_t begin, std::size_t count, ChunkedGrid& grid) {
  FreeSpace free_space;
  for (std::size_t i = begin; i < begin + count; ++i) {
    const CorrectedScan& scan = sequence.scans[i];
    grid.apply(free_space.trace(sequence.map_T_robot[i] * scan.robot_T_lidar, scan.ends_lidar,
                                max_wedge_rad(scan), grid.cell_size_m()));
  }
}

}  // namespace dynslam::bench
