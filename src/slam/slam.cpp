// SPDX-License-Identifier: MIT
#include "slam/slam.h"

#include <algorithm>
#include <utility>

#include "slam/clean_up.h"

namespace dynslam {
namespace {

/// Chunks that the back end drew anew and that a scan lets into the map: some 0.3 ms.
constexpr std::size_t kChunksATurn = 200;

}  // namespace

Slam::Slam(const SlamConfig& config, StageWatch* watch)
    : config_(config),
      watch_(watch),
      front_end_(config, watch),
      back_end_(config),
      map_(config.cell_size_m, static_cast<std::size_t>(config.max_chunks)) {}

std::optional<ScanResult> Slam::next(bool at_end) {
  const auto fix = front_end_.next(at_end);
  if (!fix) return std::nullopt;
  remember(*fix);
  close_loops();
  apply_corrections();
  draw(*fix);
  enter("");
  ScanResult result;
  result.stamp = fix->stamp;
  result.map_T_robot = map_T_drawn_ * fix->drawn_T_robot;
  result.map_T_odom = map_T_drawn_;
  result.covariance = fix->covariance;
  result.score = fix->score;
  result.quality = fix->quality;
  result.matched = fix->matched;
  result.lost = fix->lost;
  result.inserted = fix->inserted;
  result.unsteady = fix->unsteady;
  return result;
}

void Slam::keep_path(std::size_t most_scans) {
  most_visits_ = std::max<std::size_t>(most_scans, 1);
  while (visits_.size() > most_visits_) visits_.pop_front();
}

void Slam::remember(const FrontEndResult& fix) {
  ++scans_;
  visits_.push_back({fix.stamp, fix.local_map_id, fix.drawn_T_robot});
  if (visits_.size() > most_visits_) visits_.pop_front();
}

/// Hands complete local maps to the back end, or puts them by for who does.
void Slam::close_loops() {
  while (auto complete = front_end_.take_complete()) {
    if (config_.close_loops) {
      jobs_.push_back(job_for(std::move(*complete)));
    } else {  // nobody needs them, and nobody will know better where the robot is
      front_end_.found(complete->id);
    }
  }
  if (elsewhere_) return;
  while (const auto job = take_job()) {
    enter("close loops");
    corrections_.push_back(
        {scans_ + static_cast<std::size_t>(config_.correction_delay_scans), work_off(*job)});
  }
}

GraphJob Slam::job_for(LocalMap complete) const {
  GraphJob job{std::move(complete), {}, front_end_.trusts_imu(), front_end_.lost_since(), {}};
  if (scans_ > visits_.size()) job.path_from = visits_.front().local_map_id;
  if (following_ && !front_end_.local_maps().empty()) {
    const LocalMap& next = front_end_.local_maps().front();
    job.next_so_far = std::make_shared<const FinishedMap>(clean_up(next, next.id, next.ended));
  }
  return job;
}

std::optional<GraphJob> Slam::take_job() {
  if (jobs_.empty()) return std::nullopt;
  std::optional<GraphJob> job(std::move(jobs_.front()));
  jobs_.pop_front();
  return job;
}

Correction Slam::work_off(const GraphJob& job) {
  if (!job.trusts_imu) back_end_.distrust_imu();
  back_end_.finish(job.complete);
  if (job.path_from) back_end_.forget_retired_before(*job.path_from);
  Correction correction{back_end_.map_T_drawn(job.complete.id), {}, {}};
  if (job.lost_since && back_end_.knows_since(*job.lost_since)) correction.found_in = job.complete.id;
  if (job.next_so_far) {
    back_end_.preview(job.next_so_far);
    correction.chunks = back_end_.draw();
  }
  return correction;
}

/// Lets what the back end found out reach the poses and the map, when that is due.
void Slam::apply_corrections() {
  while (!corrections_.empty() && corrections_.front().due <= scans_) {
    const Correction& now = corrections_.front().correction;
    map_T_drawn_ = now.map_T_drawn;
    if (now.found_in) front_end_.found(*now.found_in);
    if (following_) map_.redrawn(now.chunks);
    corrections_.pop_front();
  }
}

/// Keeps the map up with the scan: what the back end has drawn, and the scan on top of it.
void Slam::draw(const FrontEndResult& fix) {
  if (config_.close_loops && !following_) return;
  enter("draw");
  map_.show(kChunksATurn);
  if (!fix.inserted) return;
  const ScanFootprint& scan = front_end_.footprint_in(map_T_drawn_);
  if (config_.close_loops) {
    map_.draw(scan);
  } else {
    map_.grid().apply(scan);  // there is nothing that it would be put on top of
  }
}

void Slam::finish() {
  if (!config_.close_loops) return;
  while (const auto job = take_job()) correct(work_off(*job));
  front_end_.complete_all();
  while (const auto complete = front_end_.take_complete()) back_end_.finish(*complete);
  for (const Pending& p : corrections_) map_.redrawn(p.correction.chunks);
  corrections_.clear();
  map_.settle(back_end_.draw());
}

std::vector<StampedFix> Slam::trajectory() const {
  std::vector<StampedFix> poses;
  poses.reserve(visits_.size());
  for (const Visit& v : visits_)
    poses.push_back({v.stamp, back_end_.map_T_drawn(v.local_map_id) * v.drawn_T_robot});
  return poses;
}

Counters Slam::counters() const {
  Counters all = live_counters();
  for (const auto& [name, n] : back_end_.counters()) all.add(name, n);
  return all;
}

Counters Slam::live_counters() const {
  Counters all = front_end_.counters();
  const std::uint64_t refused = map_.grid().cells_refused();
  if (refused > 0) all.add("map.cells_refused", refused);
  return all;
}

}  // namespace dynslam
