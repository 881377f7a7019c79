// SPDX-License-Identifier: MIT
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "base/counters.h"
#include "base/imu_sample.h"
#include "base/odometry.h"
#include "base/pose_estimate.h"
#include "base/scan.h"
#include "grid/chunked_grid.h"
#include "grid/free_space.h"
#include "slam/clock_jump.h"
#include "slam/local_map.h"
#include "slam/motion_model.h"
#include "slam/passes.h"
#include "slam/scan_matcher.h"
#include "slam/sensor_agreement.h"
#include "slam/slam_config.h"
#include "slam/stage_watch.h"

namespace dynslam {

/// What became of a scan, in the front end's continuous frame: that in which local maps are drawn.
struct FrontEndResult {
  Time stamp;
  Pose2 drawn_T_robot;             ///< at the stamp
  std::uint32_t local_map_id = 0;  ///< of the map it was matched against
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  double score = 0.0;     ///< as MatchResult; 1 for the first scan
  double quality = 0.0;   ///< 0 to 1: how far the pose is to be trusted
  bool lost = false;      ///< since the map no longer explained the scans, until found()
  bool matched = false;   ///< false: the map did not answer and the pose is what motion sensors say
  bool inserted = false;  ///< drawn into the local maps
  Unsteady unsteady = Unsteady::kNo;  ///< and if not, whether the robot moved too fast for it
};

/// From sensor samples to poses and local maps (thesis, figure 4.2). Its frame is continuous: poses are never
/// corrected afterwards, they drift. What the drift was, the back end finds.
///
/// Samples go in as they arrive. A scan waits until IMU and wheels have told of its whole turn, or have
/// fallen silent; then `next` takes it through the stages. Results depend on the samples and their order
/// alone, never on a clock. One thread.
class FrontEnd {
 public:
  /// `watch`, when given, must outlive this. Throws InputError for a config with a problem().
  explicit FrontEnd(const SlamConfig& config, StageWatch* watch = nullptr);

  void add(const ImuSample& sample);
  void add(const OdometrySample& sample);
  void add(Scan scan);

  /// Takes the place of the config's trusted_range_m, from the next scan on. REQUIRES: more than min_range_m,
  /// at most most_trusted_range_m().
  void trust_range(double range_m) { config_.trusted_range_m = range_m; }
  double trusted_range_m() const { return config_.trusted_range_m; }

  /// Works off the oldest scan that is ready. `at_end`: nothing more will come, do not wait for the others.
  /// A scan that is not later than the one before it is counted and passed over; a clock that was set back by
  /// more than a second is followed.
  std::optional<FrontEndResult> next(bool at_end = false);

  /// The oldest complete local map that was not yet taken.
  std::optional<LocalMap> take_complete();
  /// Declares the maps at hand complete: at the end, and when the robot is lost.
  void complete_all();
  /// The maps at hand, oldest first.
  const std::deque<LocalMap>& local_maps() const { return local_maps_; }

  /// The cells of the scan last drawn, in a map in which the drawn frame has this pose. Until the next call.
  const ScanFootprint& footprint_in(const Pose2& map_T_drawn);

  /// The first local map begun after the robot was lost; nothing while it knows where it is.
  std::optional<std::uint32_t> lost_since() const { return lost_since_; }
  /// The robot was found: a local map knew a place from before again. Says nothing of a robot that was lost
  /// anew since that map.
  void found(std::uint32_t local_map_id);
  std::size_t local_maps_begun() const { return next_id_; }
  std::size_t waiting() const { return waiting_.size(); }
  /// What is wrong with the sensors' mounting, in words for the user.
  const std::vector<std::string>& findings() const { return findings_; }
  /// Whether the IMU's heading is believed.
  bool trusts_imu() const { return motion_.trusts_imu(); }
  /// Weather: what was skipped, smoothed, refused.
  Counters counters() const;

 private:
  /// Where the robot was at a scan's reference time.
  struct Fix {
    Pose2 map_T_robot;
    MatchResult match;
    bool matched = false;  ///< the map said so
  };
  /// A scan and where it was drawn.
  struct Drawn {
    CorrectedScan scan;
    Pose2 drawn_T_robot;
  };

  void note_time(Time t);
  bool is_ready(const Scan& scan) const;
  bool is_news(const Scan& scan);
  FrontEndResult process(const Scan& scan);
  CorrectedScan correct(const Scan& scan);
  Fix first_fix(Time t);
  void go_on_blindly(const MatchPrior& prior, Fix& fix) const;
  Fix locate(const CorrectedScan& scan);
  MatchResult match(MatchPrior prior);
  bool is_doubtful(const MatchResult& match) const;
  bool is_elsewhere(const MatchResult& match, const CorrectedScan& scan) const;
  void note_usual(const MatchResult& match);
  void look_along_wheels(Time t, Fix& fix);
  void look_about(Time t, Fix& fix);
  void mistrust_leap(const CorrectedScan& scan, Fix& fix);
  double through_walls(const MatchResult& match, const CorrectedScan& scan) const;
  void compare_sensors(const Fix& fix, Time t);
  void note_match(const Fix& fix);
  Unsteady unsteady(const Scan& scan);
  bool may_insert(const Fix& fix) const;
  double quality(const Fix& fix) const;
  void lose();
  void insert(CorrectedScan&& scan, const Pose2& map_T_robot);
  const ScanFootprint& trace(const CorrectedScan& scan, const Pose2& grid_T_robot);
  void begin_local_map(const Fix& fix, Time t);
  void count_scan(const Fix& fix, Time t);
  Pose2 pose_at_stamp(const Scan& scan, const CorrectedScan& corrected, const Pose2& map_T_robot) const;
  void enter(std::string_view stage) {
    if (watch_) watch_->enter(stage);
  }

  SlamConfig config_;
  StageWatch* watch_;
  MotionModel motion_;
  SensorAgreement agreement_;
  std::vector<std::string> findings_;
  ScanMatcher matcher_;
  FreeSpace free_space_;
  std::deque<Scan> waiting_;
  Time newest_sample_;               ///< of any kind
  std::vector<MatchPoint> points_;   ///< of the scan at hand
  std::deque<LocalMap> local_maps_;  ///< one or two; the older, in front, is matched against
  std::deque<LocalMap> complete_;    ///< not yet taken
  std::uint32_t next_id_ = 0;
  Pose2 last_counted_;
  double usual_score_ = 0.0;                              ///< of the scans before, on the same map
  double usual_hit_ = 0.0;                                ///< see MatchPrior
  double usual_known_ = 0.0;                              ///< see MatchResult
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Zero();  ///< of the last fix
  std::optional<std::uint32_t> lost_since_;
  std::uint32_t lost_last_ = 0;                                ///< as lost_since_, of the last time
  Eigen::Matrix3d lost_covariance_ = Eigen::Matrix3d::Zero();  ///< of where it was then
  bool was_carried_ = false;  ///< since the last match, a scan went through walls or asked for a leap
  Drawn last_drawn_;
  int unmatched_in_a_row_ = 0;
  int unproven_ = 0;  ///< scans that have to bear a leap out before it is believed
  Pose2 last_matched_;
  std::optional<Time> last_stamp_;
  Counters counters_;
};

}  // namespace dynslam
