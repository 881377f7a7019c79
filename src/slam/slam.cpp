// SPDX-License-Identifier: MIT
#include "slam/slam.h"

#include <limits>

namespace dynslam {

Slam::Slam(const SlamConfig& config, StageWatch* watch)
    : config_(config),
      watch_(watch),
      front_end_(config, watch),
      back_end_(config),
      map_(config.cell_size_m, static_cast<std::size_t>(config.max_chunks)) {}

std::optional<ScanResult> Slam::next(bool at_end) {
  const auto fix = front_end_.next(at_end);
  if (!fix) return std::nullopt;
  visits_.push_back({fix->stamp, fix->local_map_id, fix->drawn_T_robot});
  if (config_.close_loops) {
    close_loops();
  } else {
    draw_live(*fix);
  }
  enter("");
  ScanResult result;
  result.stamp = fix->stamp;
  result.map_T_robot = map_T_drawn_ * fix->drawn_T_robot;
  result.covariance = fix->covariance;
  result.score = fix->score;
  result.matched = fix->matched;
  result.inserted = fix->inserted;
  return result;
}

/// Hands complete local maps to the back end, and lets what it found out reach the poses when that is due.
void Slam::close_loops() {
  while (const auto complete = front_end_.take_complete()) {
    enter("close loops");
    back_end_.finish(*complete);
    corrections_.push_back({visits_.size() + static_cast<std::size_t>(config_.correction_delay_scans),
                            back_end_.map_T_drawn(complete->id)});
  }
  while (!corrections_.empty() && corrections_.front().due <= visits_.size()) {
    map_T_drawn_ = corrections_.front().map_T_drawn;
    corrections_.pop_front();
  }
}

void Slam::draw_live(const FrontEndResult& fix) {
  while (front_end_.take_complete()) continue;  // nobody needs them
  enter("draw");
  if (fix.inserted) map_.apply(front_end_.footprint());
}

void Slam::finish() {
  if (!config_.close_loops) return;
  front_end_.complete_all();
  while (const auto complete = front_end_.take_complete()) back_end_.finish(*complete);
  back_end_.global_map().redraw(std::numeric_limits<std::size_t>::max());
  show(back_end_.global_map().publish());
}

void Slam::show(const std::vector<DrawnChunk>& chunks) {
  for (const DrawnChunk& c : chunks) map_.show(c.index, c.free, c.occupied);
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
  if (map_.cells_refused() > 0) all.add("map.cells_refused", map_.cells_refused());
  return all;
}

}  // namespace dynslam
