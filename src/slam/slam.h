// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <deque>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/counters.h"
#include "slam/back_end.h"
#include "slam/front_end.h"
#include "slam/live_map.h"

namespace dynslam {

/// Where a scan was taken, in the map.
struct ScanResult {
  Time stamp;
  Pose2 map_T_robot;  ///< at the stamp, as known now
  Pose2 map_T_odom;   ///< where the frame lies in which scans follow each other smoothly; jumps with a loop
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  double score = 0.0;     ///< as MatchResult; 1 for the first scan
  double quality = 0.0;   ///< 0 to 1: how far the pose is to be trusted
  bool matched = false;   ///< false: the map did not answer and the pose is what motion sensors say
  bool lost = false;      ///< the robot does not know where in the map it is, until a place is known again
  bool inserted = false;  ///< drawn into the local maps
  Unsteady unsteady = Unsteady::kNo;  ///< and if not, whether the robot moved too fast for it
};

struct StampedFix {
  Time stamp;
  Pose2 map_T_robot;
};

/// A complete local map on its way to the back end, and what the back end has to know with it.
struct GraphJob {
  LocalMap complete;
  std::shared_ptr<const FinishedMap> next_so_far;  ///< what there is of the map after it; null: nobody looks
  bool trusts_imu = true;
  std::optional<std::uint32_t> lost_since;  ///< see FrontEnd
  std::optional<std::uint32_t> path_from;   ///< of what came before this local map nothing will be asked
};

/// What came of it: since the correction before it.
struct Correction {
  Pose2 map_T_drawn;
  std::optional<std::uint32_t> found_in;  ///< the local map in which a robot that was lost was found
  std::vector<DrawnChunk> chunks;         ///< of the map that look different now
};

/// Front end and back end: from sensor samples to poses and a map of everything. Left alone it works in one
/// thread, and a correction by the back end reaches the poses a fixed number of scans later, as it would if
/// the back end had a thread of its own; so the same samples give the same results on every machine.
///
/// For a robot that must not wait for its loops, see close_loops_elsewhere(): then one other thread may call
/// work_off() at any time, and look at back_end() between two of them, and nothing else. local_maps_active(),
/// trajectory(), counters() and finish(), and back_end() for others, are only for when it does not.
class Slam {
 public:
  /// `watch`, when given, must outlive this. Throws InputError for a config with a problem().
  explicit Slam(const SlamConfig& config, StageWatch* watch = nullptr);

  void add(const ImuSample& sample) { front_end_.add(sample); }
  void add(const OdometrySample& sample) { front_end_.add(sample); }
  void add(Scan scan) { front_end_.add(std::move(scan)); }

  /// See FrontEnd::next.
  std::optional<ScanResult> next(bool at_end = false);

  /// From now on the map follows every scan, for those who look at it on the way. Otherwise, with loop
  /// closing, it is only drawn by finish().
  void follow() { following_ = true; }

  /// From now on trajectory() knows no more than the last so many scans (one at the least), and nothing is
  /// kept of what came before: for a robot that never stops. Otherwise all are kept, some 50 bytes a scan.
  void keep_path(std::size_t most_scans);

  /// See FrontEnd.
  void trust_range(double range_m) { front_end_.trust_range(range_m); }
  double trusted_range_m() const { return front_end_.trusted_range_m(); }

  /// From now on next() leaves complete local maps to the caller: to be taken, worked off, and what came of
  /// them given back, all in order.
  void close_loops_elsewhere() { elsewhere_ = true; }
  std::optional<GraphJob> take_job();
  Correction work_off(const GraphJob& job);
  /// Reaches the poses with the next scan.
  void correct(Correction correction) { corrections_.push_back({scans_, std::move(correction)}); }

  /// Takes the unfinished local maps in and draws all there is. Nothing may be added after it.
  void finish();

  /// The best that is known now of where every scan was taken, or those that keep_path() keeps.
  std::vector<StampedFix> trajectory() const;

  /// The map of everything: see follow().
  ChunkedGrid& global_map() { return map_.grid(); }
  const BackEnd& back_end() const { return back_end_; }
  std::size_t local_maps_begun() const { return front_end_.local_maps_begun(); }
  std::size_t local_maps_active() const {
    return config_.close_loops ? back_end_.global_map().active() : front_end_.local_maps().size();
  }
  std::size_t waiting() const { return front_end_.waiting(); }
  /// What is wrong with the sensors' mounting, in words for the user.
  std::vector<std::string> findings() const { return front_end_.findings(); }
  /// Weather: what was skipped, smoothed, refused.
  Counters counters() const;
  /// Its two parts, for two threads: that of next(), and that of work_off().
  Counters live_counters() const;
  Counters graph_counters() const { return back_end_.counters(); }

 private:
  struct Visit {  ///< a scan, tied to the local map it was matched against
    Time stamp;
    std::uint32_t local_map_id = 0;
    Pose2 drawn_T_robot;
  };
  struct Pending {
    std::size_t due = 0;  ///< at this many scans
    Correction correction;
  };
  void remember(const FrontEndResult& fix);
  void close_loops();
  GraphJob job_for(LocalMap complete) const;
  void apply_corrections();
  void draw(const FrontEndResult& fix);
  void enter(std::string_view stage) {
    if (watch_) watch_->enter(stage);
  }

  SlamConfig config_;
  StageWatch* watch_;
  FrontEnd front_end_;
  BackEnd back_end_;
  bool following_ = false;
  LiveMap map_;
  std::size_t scans_ = 0;
  std::size_t most_visits_ = std::numeric_limits<std::size_t>::max();
  std::deque<Visit> visits_;  ///< the last scans
  bool elsewhere_ = false;
  std::deque<GraphJob> jobs_;
  std::deque<Pending> corrections_;
  Pose2 map_T_drawn_;  ///< as known to the poses
};

}  // namespace dynslam
