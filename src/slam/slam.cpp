// SPDX-License-Identifier: MIT
#include "slam/slam.h"

#include <algorithm>
#include <utility>

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
  draw(*fix);
  enter("");
  ScanResult result;
  result.stamp = fix->stamp;
  result.map_T_robot = map_T_drawn_ * fix->drawn_T_robot;
  result.covariance = fix->covariance;
  result.score = fix->score;
  result.quality = fix->quality;
  result.matched = fix->matched;
  result.lost = fix->lost;
  result.inserted = fix->inserted;
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

/// Hands complete local maps to the back end, and lets what it found out reach the poses when that is due.
void Slam::close_loops() {
  while (const auto complete = front_end_.take_complete()) {
    if (!config_.close_loops) {  // nobody needs them, and nobody will know better where the robot is
      front_end_.found(complete->id);
      continue;
    }
    enter("close loops");
    take_in(*complete);
  }
  while (!corrections_.empty() && corrections_.front().due <= scans_) {
    Correction& now = corrections_.front();
    map_T_drawn_ = now.map_T_drawn;
    if (now.found_in) front_end_.found(*now.found_in);
    if (following_) map_.redrawn(now.chunks);
    corrections_.pop_front();
  }
}

void Slam::take_in(const LocalMap& complete) {
  if (!front_end_.trusts_imu()) back_end_.distrust_imu();
  back_end_.finish(complete);
  if (scans_ > visits_.size()) back_end_.forget_retired_before(visits_.front().local_map_id);
  const auto lost = front_end_.lost_since();
  Correction correction{scans_ + static_cast<std::size_t>(config_.correction_delay_scans),
                        back_end_.map_T_drawn(complete.id),
                        {},
                        {}};
  if (lost && back_end_.knows_since(*lost)) correction.found_in = complete.id;
  if (following_) {
    if (!front_end_.local_maps().empty()) back_end_.preview(front_end_.local_maps().front());
    correction.chunks = back_end_.draw();
  }
  corrections_.push_back(std::move(correction));
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
  front_end_.complete_all();
  while (const auto complete = front_end_.take_complete()) back_end_.finish(*complete);
  for (const Correction& c : corrections_) map_.redrawn(c.chunks);
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
  Counters all = front_end_.counters();
  for (const auto& [name, n] : back_end_.counters()) all.add(name, n);
  const std::uint64_t refused = map_.grid().cells_refused();
  if (refused > 0) all.add("map.cells_refused", refused);
  return all;
}

}  // namespace dynslam
