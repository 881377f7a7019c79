// SPDX-License-Identifier: MIT
#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "base/counters.h"
#include "base/imu_sample.h"
#include "base/odometry.h"
#include "base/scan.h"
#include "grid/chunked_grid.h"
#include "grid/free_space.h"
#include "slam/clock_jump.h"
#include "slam/local_map.h"
#include "slam/motion_model.h"
#include "slam/passes.h"
#include "slam/scan_matcher.h"
#include "slam/slam_config.h"
#include "slam/stage_watch.h"

namespace dynslam {

/// What became of a scan.
struct ScanResult {
  Time stamp;
  Pose2 map_T_robot;  ///< at the stamp
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  double score = 0.0;     ///< as MatchResult; 1 for the first scan
  bool matched = false;   ///< false: the map did not answer and the pose is what motion sensors say
  bool inserted = false;  ///< drawn into the maps
};

/// From sensor samples to poses and a map (thesis, figures 4.2 and 4.3): the sum of this folder.
///
/// Samples go in as they arrive. A scan waits until the IMU has told of its whole turn, or has fallen silent;
/// then `next` takes it through the stages. Results depend on the samples and their order alone, never on a
/// clock. One thread.
class Slam {
 public:
  /// `watch`, when given, must outlive this. Throws InputError when a trusted ray is longer than 8000 cells.
  explicit Slam(const SlamConfig& config, StageWatch* watch = nullptr);

  void add(const ImuSample& sample);
  void add(const OdometrySample& sample);
  void add(Scan scan);

  /// Works off the oldest scan that is ready. `at_end`: nothing more will come, do not wait for the IMU.
  /// A scan that is not later than the one before it is counted and passed over; a clock that was set back by
  /// more than a second is followed.
  std::optional<ScanResult> next(bool at_end = false);

  /// All scans drawn so far.
  ChunkedGrid& global_map() { return global_map_; }
  const ChunkedGrid& global_map() const { return global_map_; }

  std::size_t local_maps_begun() const { return local_maps_begun_; }
  std::size_t local_maps_active() const { return local_maps_.size(); }
  std::size_t waiting() const { return waiting_.size(); }
  /// Weather: what was skipped, smoothed, refused.
  Counters counters() const;

 private:
  /// Where the robot was at a scan's reference time.
  struct Fix {
    Pose2 map_T_robot;
    MatchResult match;
    bool matched = false;  ///< the map said so
  };

  void note_time(Time t);
  bool is_ready(const Scan& scan) const;
  bool is_news(const Scan& scan);
  ScanResult process(const Scan& scan);
  CorrectedScan correct(const Scan& scan);
  Fix first_fix(Time t);
  Fix locate(const CorrectedScan& scan);
  bool may_insert(const Scan& scan, const Fix& fix);
  void insert(const CorrectedScan& scan, const Pose2& map_T_robot);
  void begin_local_map(const Pose2& map_T_robot, Time t);
  void count_scan(const Pose2& map_T_robot, Time t);
  Pose2 pose_at_stamp(const Scan& scan, const CorrectedScan& corrected, const Pose2& map_T_robot) const;
  void enter(std::string_view stage) {
    if (watch_) watch_->enter(stage);
  }

  SlamConfig config_;
  StageWatch* watch_;
  MotionModel motion_;
  ScanMatcher matcher_;
  FreeSpace free_space_;
  std::deque<Scan> waiting_;
  Time newest_sample_;               ///< of any kind
  std::vector<MatchPoint> points_;   ///< of the scan at hand
  std::deque<LocalMap> local_maps_;  ///< one or two; the older, in front, is matched against
  std::size_t local_maps_begun_ = 0;
  ChunkedGrid global_map_;
  Pose2 last_counted_;
  double usual_hit_ = 0.0;  ///< see MatchPrior
  int unmatched_in_a_row_ = 0;
  std::optional<Time> last_stamp_;
  Counters counters_;
};

}  // namespace dynslam
