// SPDX-License-Identifier: MIT
#include "slam/front_end.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "base/error.h"
#include "slam/match_points.h"
#include "slam/relative_pose.h"
#include "slam/wall_crossing.h"

namespace dynslam {
namespace {

/// How long a scan waits for an IMU or wheels that have stopped talking, counted in the time of other
/// samples.
constexpr Duration kMotionPatience = std::chrono::milliseconds(150);
/// Wheels that have been silent for so long are not waited for any more, or each pose would be late for ever.
constexpr Duration kWheelsGone = std::chrono::seconds(1);
/// Where a pose is nonsense, metres from the origin either way, and odometry too.
constexpr double kFarthest_m = 1e6;
constexpr double kFarthestOdometry_m = 1e7;
/// Less than this since the last scan that counted: the robot stands.
constexpr double kStanding_m = 0.02;
constexpr double kStanding_rad = 0.01;
/// How far the norm of an orientation may be from one.
constexpr double kUnitNorm = 0.05;
/// After so many scans that the map does not explain, or so long a way, a new map begins where motion sensors
/// say the robot is.
constexpr int kMostUnmatched = 20;
constexpr double kMostBlind_m = 1.0;
/// What wheels know after such a way. A robot that was carried meanwhile, or has none, knows nothing.
constexpr double kBlind_m = 0.6;
constexpr double kBlind_rad = 0.3;
/// When less of the scan lies on what the map holds, the prior is doubted; it is set aside for an answer that
/// fits so much better.
constexpr double kPoorlyMatched = 0.65;
constexpr double kPoorScore = 0.65;  ///< of the usual
/// With less than this of the usual score a place that the map knows is not this one.
constexpr double kAllKnown = 0.85;
constexpr double kLeastScore = 0.42;
constexpr double kClearlyBetter = 0.2;
/// A place is another when so much of the scan would have been seen through walls and less than this of what
/// the map can speak of agrees with it. (In recordings 0.65 and more agrees; where there is less, no walls
/// are in between.)
constexpr double kThroughWalls = 0.1;
constexpr double kLeastAgreeing = 0.5;
/// When so much less of the scan lies in space that the map knows than in the scans before, it is looked
/// into.
constexpr double kSuddenlyUnknown = 0.15;
/// So many scans after a leap have to bear it out.
constexpr int kProofOfLeap = 5;
/// How fast the usual hit and score follow the scans.
constexpr double kUsualShare = 0.2;

/// Share of the points that speak for a match less the share that speak against it.
double fit_of(const MatchResult& result) { return result.known * (2 * result.matched - 1); }

/// Enough of the scan lies in space the map knows, and enough of that on what the map holds.
bool is_believable(const MatchResult& result) { return result.known > 0.1 && result.matched > 0.4; }

bool is_within(const Pose2& pose, double reach_m) {
  return is_finite(pose) && std::abs(pose.x) < reach_m && std::abs(pose.y) < reach_m;
}

}  // namespace

FrontEnd::FrontEnd(const SlamConfig& config, StageWatch* watch)
    : config_(config), watch_(watch), matcher_({.search_half_width_m = config.search_half_width_m}) {
  if (const auto problem = config.problem()) throw InputError(*problem);
}

void FrontEnd::add(const ImuSample& sample) {
  const auto norm = sample.world_q_robot.norm();
  if (!(std::abs(norm - 1.0) < kUnitNorm)) {  // nor what is not a number
    counters_.add("imu.nonsense");
    return;
  }
  note_time(sample.stamp);
  motion_.add(sample);
}

void FrontEnd::add(const OdometrySample& sample) {
  if (!is_within(sample.odom_T_robot, kFarthestOdometry_m)) {
    counters_.add("odometry.nonsense");
    return;
  }
  note_time(sample.stamp);
  motion_.add(sample);
}

void FrontEnd::add(Scan scan) {
  note_time(scan.stamp);
  waiting_.push_back(std::move(scan));
}

void FrontEnd::note_time(Time t) {
  newest_sample_ = is_clock_jump(newest_sample_, t) ? t : std::max(newest_sample_, t);
}

bool FrontEnd::is_ready(const Scan& scan) const {
  const Time end = scan.stamp + from_seconds(scan.beams.empty() ? 0.0 : scan.beams.back().time_s);
  const bool imu_told = motion_.imu().empty() || motion_.imu().settled() >= end;
  const bool wheels_told = motion_.odometry().empty() || motion_.odometry().newest() >= end ||
                           motion_.odometry().newest() + kWheelsGone < scan.stamp;
  return (imu_told && wheels_told) || newest_sample_ > end + kMotionPatience ||
         is_clock_jump(end, newest_sample_);
}

std::optional<FrontEndResult> FrontEnd::next(bool at_end) {
  while (!waiting_.empty() && (at_end || is_ready(waiting_.front()))) {
    const Scan scan = std::move(waiting_.front());
    waiting_.pop_front();
    if (is_news(scan)) return process(scan);
  }
  return std::nullopt;
}

/// Whether a scan is later than the one before. A clock that was set back by a lot starts a new count.
bool FrontEnd::is_news(const Scan& scan) {
  if (last_stamp_ && scan.stamp <= *last_stamp_) {
    const bool jumped = is_clock_jump(*last_stamp_, scan.stamp);
    counters_.add(jumped ? "slam.clock_jumps" : "slam.scans_out_of_order");
    if (!jumped) return false;
  }
  last_stamp_ = scan.stamp;
  return true;
}

FrontEndResult FrontEnd::process(const Scan& scan) {
  enter("passes");
  CorrectedScan corrected = correct(scan);
  choose_points(corrected, config_.cell_size_m, points_);

  enter("match");
  const Fix fix = local_maps_.empty() ? first_fix(corrected.reference) : locate(corrected);
  FrontEndResult result;
  result.stamp = scan.stamp;
  result.drawn_T_robot = pose_at_stamp(scan, corrected, fix.map_T_robot);
  result.covariance = covariance_ = fix.match.covariance;
  result.score = fix.match.score;
  result.matched = fix.matched;
  result.quality = quality(fix);

  enter("insert");
  note_match(fix);
  compare_sensors(fix, corrected.reference);
  result.unsteady = unsteady(scan);
  result.inserted = result.unsteady == Unsteady::kNo && may_insert(fix);
  motion_.fix(corrected.reference, fix.map_T_robot, fix.matched);
  // Before it may become complete and make room for the next.
  result.local_map_id = local_maps_.empty() ? next_id_ : local_maps_.front().id;
  if (result.inserted) {
    count_scan(fix, corrected.reference);
    insert(std::move(corrected), fix.map_T_robot);
  }
  result.lost = lost_since_.has_value();
  if (result.lost) result.covariance += lost_covariance_;
  return result;
}

/// A sensor that means the opposite of what the map says loses its vote, and is named.
void FrontEnd::compare_sensors(const Fix& fix, Time t) {
  if (!fix.matched || !motion_.has_fix()) return;
  const Time before = motion_.last_time();
  agreement_.note(motion_.last_pose().inverse() * fix.map_T_robot, motion_.imu_turn(before, t),
                  motion_.wheel_motion(before, t));
  if (agreement_.imu_turns_backwards() || agreement_.imu_hangs()) motion_.distrust_imu();
  if (agreement_.wheels_turn_backwards() || agreement_.wheels_drive_backwards()) motion_.distrust_wheels();
  for (std::string& f : agreement_.findings()) {  // once found it stays found: the sensor is not asked again
    if (std::find(findings_.begin(), findings_.end(), f) == findings_.end())
      findings_.push_back(std::move(f));
  }
}

/// Counts scans that the map does not explain; after too many, or too long a way, a new map begins. A scan
/// that shows nothing says nothing against the map.
void FrontEnd::note_match(const Fix& fix) {
  if (!fix.matched) counters_.add("slam.scans_unmatched");
  if (points_.empty()) return;
  unmatched_in_a_row_ = fix.matched ? 0 : unmatched_in_a_row_ + 1;
  if (unmatched_in_a_row_ == 0) last_matched_ = fix.map_T_robot;
  const double blind_m = (fix.map_T_robot.translation() - last_matched_.translation()).norm();
  if (unmatched_in_a_row_ <= kMostUnmatched && blind_m <= kMostBlind_m) return;
  lose();
  last_matched_ = fix.map_T_robot;
}

/// Begins anew where motion sensors say the robot is. Whether that is right shows when a place from before is
/// known again.
void FrontEnd::lose() {
  counters_.add("slam.times_lost");
  complete_all();
  if (!lost_since_) lost_since_ = next_id_;
  lost_last_ = next_id_;
  lost_covariance_ =
      motion_.has_wheels() && !was_carried_ ? spread(kBlind_m, kBlind_rad) : spread(kLost_m, kLost_rad);
  unmatched_in_a_row_ = unproven_ = 0;
  usual_hit_ = usual_score_ = usual_known_ = 0.0;
}

void FrontEnd::found(std::uint32_t local_map_id) {
  if (!lost_since_ || local_map_id < lost_last_) return;
  counters_.add("slam.times_found");
  lost_since_.reset();
}

/// The share of the scan that the map explains, as well as it usually does; less where it hardly knows the
/// place, and little while the robot is lost or a leap is not borne out.
double FrontEnd::quality(const Fix& fix) const {
  constexpr double kWellKnown = 0.3, kWhileLost = 0.3;
  const double most = lost_since_ || unproven_ > 0 ? kWhileLost : 1.0;
  if (!fix.matched) return 0.0;
  const MatchResult& m = fix.match;
  if (usual_score_ <= 0) return most;  // the first of a map
  const double as_usual = std::min(1.0, m.score / usual_score_), known = std::min(1.0, m.known / kWellKnown);
  return m.matched * as_usual * known * most;
}

/// No scan that was smeared by a fast turn is drawn.
Unsteady FrontEnd::unsteady(const Scan& scan) {
  const bool takes_time = !scan.beams.empty() && scan.beams.back().time_s != scan.beams.front().time_s;
  if (!takes_time) return Unsteady::kNo;
  const Time middle = reference_time(scan);
  if (std::abs(motion_.yaw_rate(middle)) > config_.skip_yaw_rate_radps) {
    counters_.add("slam.scans_skipped_turning");
    return Unsteady::kTurning;
  }
  if (motion_.imu().tilt_rate(middle) > config_.skip_tilt_rate_radps) {
    counters_.add("slam.scans_skipped_tilting");
    return Unsteady::kTilting;
  }
  return Unsteady::kNo;
}

/// Only what is known to be in its place is drawn.
bool FrontEnd::may_insert(const Fix& fix) const {
  return ((fix.matched && unproven_ == 0) || local_maps_.empty()) && !points_.empty();
}

CorrectedScan FrontEnd::correct(const Scan& scan) {
  std::vector<Ray> rays = clamp_pass(scan, config_);
  if (!motion_.imu().empty()) level_pass(scan, motion_.tilt_around(), {}, rays);
  CorrectedScan corrected = egomotion_pass(scan, rays, motion_.motion_around(reference_time(scan)));
  stray_ray_pass(corrected);
  return corrected;
}

/// With no map yet, the robot is where motion sensors say, at first at the origin; a scan that shows anything
/// will do.
FrontEnd::Fix FrontEnd::first_fix(Time t) {
  Fix fix;
  fix.map_T_robot = motion_.has_fix() ? motion_.expect(t).map_T_robot : Pose2{};
  fix.matched = !points_.empty();
  fix.match.score = fix.matched ? 1.0 : 0.0;
  return fix;
}

/// Where the scan was taken, by the map; where the map does not answer, see go_on_blindly.
FrontEnd::Fix FrontEnd::locate(const CorrectedScan& scan) {
  const MatchPrior prior = motion_.expect(scan.reference);
  Fix fix;
  fix.match = match(prior);
  if (motion_.wheels_leap(scan.reference)) look_along_wheels(scan.reference, fix);
  if (is_doubtful(fix.match)) look_about(scan.reference, fix);
  fix.matched = is_believable(fix.match) && !is_elsewhere(fix.match, scan);
  was_carried_ = was_carried_ || (is_believable(fix.match) && !fix.matched);
  mistrust_leap(scan, fix);
  if (fix.matched && unproven_ == 0) was_carried_ = false;
  fix.map_T_robot = fix.match.map_T_robot;
  if (!fix.matched) go_on_blindly(prior, fix);
  if (!is_within(fix.map_T_robot, kFarthest_m)) {
    counters_.add("slam.nonsense_poses");
    fix.map_T_robot = motion_.last_pose();
    fix.matched = false;
  }
  if (fix.matched) note_usual(fix.match);
  return fix;
}

/// Less of the scan lies on the map than should, or it lies there worse than the scans before.
bool FrontEnd::is_doubtful(const MatchResult& match) const {
  return match.matched < kPoorlyMatched || match.score < kPoorScore * usual_score_;
}

/// The map knows all of the place and explains the scan badly; or the scan looks through its walls.
bool FrontEnd::is_elsewhere(const MatchResult& match, const CorrectedScan& scan) const {
  if (match.known > kAllKnown && match.score < kLeastScore * usual_score_) return true;
  if (!is_doubtful(match) && match.known > usual_known_ - kSuddenlyUnknown) return false;
  const double through = through_walls(match, scan);
  const double agreeing = match.known * match.matched / std::min(1.0, match.known + through);
  return through > kThroughWalls && agreeing < kLeastAgreeing;
}

double FrontEnd::through_walls(const MatchResult& match, const CorrectedScan& scan) const {
  return share_through_walls(local_maps_.front().grid, points_, match.map_T_robot,
                             scan.robot_T_lidar.translation());
}

/// The motion sensors' word stands, and what it is worth adds up.
void FrontEnd::go_on_blindly(const MatchPrior& prior, Fix& fix) const {
  fix.map_T_robot = prior.map_T_robot;
  fix.match.covariance = covariance_ + spread(prior.sigma_xy_m, prior.sigma_yaw_rad);
}

void FrontEnd::note_usual(const MatchResult& match) {
  const double share = usual_hit_ == 0 ? 1.0 : kUsualShare;
  usual_hit_ += share * (match.mean_hit - usual_hit_);
  usual_score_ += share * (match.score - usual_score_);
  usual_known_ += share * (match.known - usual_known_);
}

MatchResult FrontEnd::match(MatchPrior prior) {
  prior.usual_hit = usual_hit_;
  return matcher_.match(local_maps_.front().grid, points_, prior);
}

/// The wheels' count stood still or caught up: unless the scan clearly says otherwise, as it cannot along a
/// corridor, the longer way is right.
void FrontEnd::look_along_wheels(Time t, Fix& fix) {
  const auto longer = motion_.expect_by_longer_way(t);
  if (!longer) return;
  counters_.add("slam.wheels_leapt");
  const MatchResult other = match(*longer);
  if (is_believable(other) && fit_of(other) > fit_of(fix.match) - kClearlyBetter) fix.match = other;
}

/// A prior that the scan contradicts is set aside for a wider look.
void FrontEnd::look_about(Time t, Fix& fix) {
  const MatchResult other = match(motion_.expect_doubting_wheels(t));
  if (!is_believable(other) || fit_of(other) <= fit_of(fix.match) + kClearlyBetter) return;
  counters_.add("slam.priors_set_aside");
  fix.match = other;
}

/// A robot that was carried away may be found in a place that happens to look like its own. That scan and
/// those after it have to fit well, and none is drawn until then: it would make the place look like what it
/// is not.
void FrontEnd::mistrust_leap(const CorrectedScan& scan, Fix& fix) {
  const bool leaps = fix.matched && motion_.is_leap(scan.reference, fix.match.map_T_robot);
  unproven_ = leaps ? kProofOfLeap : std::max(0, unproven_ - 1);
  if (leaps) counters_.add("slam.leaps");
  was_carried_ = was_carried_ || leaps;
  if (unproven_ == 0 || !fix.matched) return;
  fix.matched = !is_doubtful(fix.match) && through_walls(fix.match, scan) < kThroughWalls;
}

void FrontEnd::begin_local_map(const Fix& fix, Time t) {
  local_maps_.emplace_back(config_.cell_size_m, static_cast<std::size_t>(config_.max_chunks), fix.map_T_robot,
                           t);
  local_maps_.back().id = next_id_++;
  local_maps_.back().imu_heading_rad = motion_.imu_heading(t);
  const bool is_tied = local_maps_.size() > 1;
  local_maps_.back().is_tied = is_tied;
  local_maps_.back().origin_covariance = is_tied ? fix.match.covariance : lost_covariance_;
}

void FrontEnd::complete_all() {
  for (LocalMap& m : local_maps_) complete_.push_back(std::move(m));
  local_maps_.clear();
}

std::optional<LocalMap> FrontEnd::take_complete() {
  if (complete_.empty()) return std::nullopt;
  LocalMap map = std::move(complete_.front());
  complete_.pop_front();
  return map;
}

/// Keeps two local maps going, half a map apart, so that no scan is matched against an empty one. Scans taken
/// standing are drawn but do not count.
void FrontEnd::count_scan(const Fix& fix, Time t) {
  const Pose2& map_T_robot = fix.map_T_robot;
  const Pose2 moved = last_counted_.inverse() * map_T_robot;
  const double distance = moved.translation().norm();
  if (local_maps_.empty()) {
    begin_local_map(fix, t);
  } else if (distance < kStanding_m && std::abs(moved.yaw) < kStanding_rad) {
    return;
  }
  last_counted_ = map_T_robot;
  for (LocalMap& m : local_maps_) {
    m.scans += 1;
    m.travel_m += m.scans > 1 ? distance : 0.0;
    m.robot_positions.push_back(map_T_robot.translation());
    m.ended = t;
  }
  const LocalMap& older = local_maps_.front();
  if (older.scans >= config_.scans_per_local_map || older.travel_m >= config_.travel_per_local_map_m) {
    if (local_maps_.size() > 1) {
      complete_.push_back(std::move(local_maps_.front()));
      local_maps_.pop_front();
    }
  }
  const LocalMap& oldest = local_maps_.front();
  const bool half = 2 * oldest.scans >= config_.scans_per_local_map ||
                    2 * oldest.travel_m >= config_.travel_per_local_map_m;
  if (half && local_maps_.size() < 2) begin_local_map(fix, t);
}

void FrontEnd::insert(CorrectedScan&& scan, const Pose2& map_T_robot) {
  const ScanFootprint& footprint = trace(scan, map_T_robot);
  for (LocalMap& m : local_maps_) m.grid.apply(footprint);
  last_drawn_ = {std::move(scan), map_T_robot};
}

const ScanFootprint& FrontEnd::trace(const CorrectedScan& scan, const Pose2& grid_T_robot) {
  const double max_wedge = std::min(2.5 * scan.beam_step_rad, radians(5.0));
  return free_space_.trace(grid_T_robot * scan.robot_T_lidar, scan.ends_lidar, max_wedge,
                           config_.cell_size_m);
}

const ScanFootprint& FrontEnd::footprint_in(const Pose2& map_T_drawn) {
  if (map_T_drawn == Pose2{}) return free_space_.footprint();
  return trace(last_drawn_.scan, map_T_drawn * last_drawn_.drawn_T_robot);
}

/// The scan's pose is that of its middle; its stamp is that of its first beam, a few centimetres of way
/// earlier.
Pose2 FrontEnd::pose_at_stamp(const Scan& scan, const CorrectedScan& corrected,
                              const Pose2& map_T_robot) const {
  const Pose2 back = motion_.motion_around(corrected.reference)(scan.stamp);
  Pose2 at = map_T_robot * back;
  if (motion_.has_fix() && motion_.last_time() <= scan.stamp && corrected.reference > motion_.last_time()) {
    const double share =
        to_seconds(scan.stamp - motion_.last_time()) / to_seconds(corrected.reference - motion_.last_time());
    const Pose2 between = interpolate(motion_.last_pose(), map_T_robot, share);
    at.x = between.x;
    at.y = between.y;
  }
  return at;
}

Counters FrontEnd::counters() const {
  Counters all = counters_;
  const auto add = [&](std::string_view name, std::uint64_t n) {
    if (n > 0) all.add(name, n);
  };
  add("imu.spikes_smoothed", motion_.imu().spikes_smoothed());
  add("imu.samples_out_of_order", motion_.imu().out_of_order());
  add("odometry.samples_out_of_order", motion_.odometry().out_of_order());
  return all;
}

}  // namespace dynslam
