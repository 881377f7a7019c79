// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <vector>

#include "base/imu_sample.h"
#include "base/odometry.h"
#include "pipe/bounded_queue.h"
#include "robot/ports.h"
#include "slam/slam.h"

namespace dynslam {

/// Takes what the sensors said through SLAM, and tells where the robot is and what the map looks like. One
/// thread; with a graph thread beside it, loops are closed there.
class SlamStage {
 public:
  /// Told of each scan that was worked off.
  using Notice = std::function<void(const ScanResult&)>;

  SlamStage(Slam& slam, Ports& ports, const Clock& clock) : slam_(slam), ports_(ports), clock_(clock) {
    ports.trusted_range_m = slam.trusted_range_m();
  }

  void add(ImuSample sample) { imu_.push(std::move(sample)); }
  void add(const OdometrySample& sample) { odometry_.push(sample); }
  void add(std::shared_ptr<const Scan> scan) { scans_.push(std::move(scan)); }
  void on_scan(Notice notice) { notice_ = std::move(notice); }

  /// Waits a moment for a scan and works off what is ready.
  void turn();
  /// For the graph thread: waits a moment for a complete local map and closes its loops.
  void graph_turn();
  /// Nobody waits any more, nor works off what has piled up: that is left to finish().
  void close();
  /// Works off what is under way. REQUIRES: no other thread is in here.
  void finish();

  /// What the queues lost. Any thread.
  Counters queue_counters() const;

 private:
  void take_motion();
  void show(const ScanResult& result);

  Slam& slam_;
  Ports& ports_;
  const Clock& clock_;
  Notice notice_;
  std::atomic<bool> closed_{false};
  Time counters_due_;
  BoundedQueue<ImuSample> imu_{256};
  BoundedQueue<OdometrySample> odometry_{256};
  BoundedQueue<std::shared_ptr<const Scan>> scans_{4};
  BoundedQueue<GraphJob> jobs_{64};
  /// Each says what changed since the one before: all are needed, in their order.
  BoundedQueue<Correction> corrections_{64};
};

}  // namespace dynslam
