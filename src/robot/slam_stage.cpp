// SPDX-License-Identifier: MIT
#include "robot/slam_stage.h"

#include <utility>

namespace dynslam {
namespace {

/// So often is it looked whether the IMU has told of a scan's whole turn.
constexpr Duration kMoment = std::chrono::milliseconds(10);
constexpr Duration kShowCountersEvery = std::chrono::seconds(1);
constexpr Duration kGraphPatience = std::chrono::milliseconds(200);

}  // namespace

void SlamStage::turn() {
  const auto scan = scans_.pop(clock_.steady(clock_.now() + kMoment));
  take_motion();
  if (scan) slam_.add(Scan(**scan));
  while (auto correction = corrections_.try_pop()) slam_.correct(std::move(*correction));
  slam_.trust_range(ports_.trusted_range_m);
  while (!closed_) {
    const auto result = slam_.next();
    if (!result) return;
    while (auto job = slam_.take_job()) jobs_.push(std::move(*job));
    show(*result);
  }
}

void SlamStage::take_motion() {
  while (const auto sample = imu_.try_pop()) slam_.add(*sample);
  while (const auto sample = odometry_.try_pop()) slam_.add(*sample);
}

void SlamStage::graph_turn() {
  auto job = jobs_.pop(clock_.steady(clock_.now() + kGraphPatience));
  if (!job) return;
  corrections_.push(slam_.work_off(*job));
  ports_.graph_counters.put(slam_.graph_counters());
  ports_.graph.put(graph_view(slam_.back_end()));
}

void SlamStage::close() {
  closed_ = true;
  scans_.close();
  jobs_.close();
}

void SlamStage::finish() {
  take_motion();
  while (const auto scan = scans_.try_pop()) slam_.add(Scan(**scan));
  while (auto correction = corrections_.try_pop()) slam_.correct(std::move(*correction));
  while (const auto job = jobs_.try_pop()) slam_.correct(slam_.work_off(*job));
  while (const auto result = slam_.next()) {
    while (const auto job = slam_.take_job()) slam_.correct(slam_.work_off(*job));
    show(*result);
  }
  slam_.finish();
  ports_.graph.put(graph_view(slam_.back_end()));  // what was worked off here, nobody was told of
}

Counters SlamStage::queue_counters() const {
  Counters all;
  const auto add = [&all](const char* name, std::uint64_t n) {
    if (n > 0) all.add(name, n);
  };
  add("queue.scans_dropped", scans_.dropped());
  add("queue.imu_dropped", imu_.dropped());
  add("queue.odometry_dropped", odometry_.dropped());
  add("queue.local_maps_dropped", jobs_.dropped());
  return all;
}

void SlamStage::show(const ScanResult& r) {
  ports_.world.put(
      {{r.stamp, r.map_T_robot, r.covariance, r.quality, r.lost, r.unsteady}, slam_.global_map().snapshot()});
  if (r.stamp >= counters_due_ || r.stamp + kShowCountersEvery < counters_due_) {
    counters_due_ = r.stamp + kShowCountersEvery;
    Counters all = queue_counters();
    for (const auto& [name, n] : slam_.live_counters()) all.add(name, n);
    ports_.slam_counters.put(std::move(all));
  }
  if (notice_) notice_(r);
}

}  // namespace dynslam
