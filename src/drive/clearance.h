// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/config_field.h"
#include "base/twist.h"
#include "drive/glass_watch.h"
#include "drive/near_memory.h"
#include "drive/obstacle_points.h"
#include "drive/sweep.h"
#include "drive/walker_watch.h"

namespace dynslam {

/// Section [clearance] of the configuration: how much room the robot keeps. The reaction time is that of
/// motors and wheels besides a tick; the age of a scan is dealt with apart.
struct ClearanceConfig {
  double reaction_s = 0.25;
  double deceleration_mps2 = 1.5;
  double stop_margin_m = 0.1;
  double side_margin_m = 0.03;
  double creep_mps = 0.1;
  double creep_margin_m = 0.01;
  double min_range_m = 0.1;
  double blind_m = 0.2;

  /// What is wrong with the values together, if anything.
  std::optional<std::string> problem() const {
    if (creep_margin_m > side_margin_m) return "clearance.creep_margin_m: more than clearance.side_margin_m";
    if (side_margin_m > stop_margin_m) return "clearance.side_margin_m: more than clearance.stop_margin_m";
    return std::nullopt;
  }

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"reaction_s", "time until the wheels begin to brake", 0.0, 2.0}, self.reaction_s);
    visit(Field{"deceleration_mps2", "how hard the robot can surely brake on any floor", 0.1, 20.0},
          self.deceleration_mps2);
    visit(Field{"stop_margin_m", "room that is left to what lies in the way", 0.005, 2.0},
          self.stop_margin_m);
    visit(Field{"side_margin_m", "room that is left on the other sides", 0.005, 2.0}, self.side_margin_m);
    visit(Field{"creep_mps", "slower than this, less room on the sides is enough", 0.0, 2.0}, self.creep_mps);
    visit(Field{"creep_margin_m", "namely so much", 0.005, 2.0}, self.creep_margin_m);
    visit(Field{"min_range_m", "returns nearer to the lidar are no obstacles", 0.0, 5.0}, self.min_range_m);
    visit(Field{"blind_m", "the lidar sees nothing nearer than this: what came so near is remembered", 0.0,
                1.0},
          self.blind_m);
  }
};

/// How much of a motion is free.
struct ClearWay {
  double share = 1.0;       ///< of the wanted twist, at which the robot stops in time; 0: not that way
  double distance_m = 0.0;  ///< from the body to what limits it, when share < 1
};

/// The collision zone: sweeps the robot's rectangle along the arc that is wanted through the newest scan's
/// returns. The scan is old by the time it is used: the robot may have moved as commanded since then, or not
/// at all yet, and has to stop in time in both cases. It sees the lidar's plane only, and no further than
/// where the lidar looked; what is too near for the lidar it remembers, and of glass what it met squarely.
/// What moves towards the robot is taken to stand still, but who walked lately has room for a step.
class Clearance {
 public:
  explicit Clearance(const BodyConfig& body = {}, const ClearanceConfig& config = {})
      : body_(body),
        config_(config),
        near_(config.blind_m),
        glass_(config.blind_m),
        walkers_(config.blind_m) {}

  /// The newest scan to go by.
  void see(const Scan& scan, const RecentMotion& motion);
  void forget() {
    end_.reset();
    near_.forget();
    glass_.forget();
    walkers_.forget();
  }
  /// Of glass, from the robot at the end of the newest scan: beams that are not square to it go through.
  std::vector<Segment> panes() const { return glass_.panes(); }
  /// How much of `twist` is free; nothing of it without a scan. Other motions may be free when this one is
  /// not. The allowed speed depends on the arc, not on how fast it is asked for. REQUIRES: finite.
  ClearWay way(Time now, const Twist& twist, const RecentMotion& motion) const;

  /// So far the body's fastest point can go along `twist` with so much room left on the sides; infinite when
  /// nothing is in its way, nothing without a scan. REQUIRES: finite.
  double free_m(Time now, const Twist& twist, const RecentMotion& motion, double side_margin_m) const;

  /// From the body to the nearest thing that is ahead or beside; infinite when nothing is.
  double nearest_m(Time now, const RecentMotion& motion) const;

  /// The way to standstill of the point of the body that moves at this speed.
  double stopping_distance_m(double speed_mps) const;
  /// The fastest speed that stops within such a way.
  double safe_speed_mps(double distance_m) const;
  /// The speed of the body's fastest point, at most.
  double body_speed_mps(const Twist& t) const {
    return std::abs(t.v_mps) + std::abs(t.w_radps) * body_.radius_m();
  }

 private:
  struct Contact {
    double time_s, distance_m;
  };
  Contact first_contact(const Sweep& sweep, const Pose2& now_T_end, double horizon_m) const;
  Contact first_contact(Time now, const Twist& twist, const RecentMotion& motion, double side_margin_m) const;
  double distance_to_body_m(double x, double y) const;

  BodyConfig body_;
  ClearanceConfig config_;
  NearMemory near_;
  GlassWatch glass_;
  WalkerWatch walkers_;
  std::vector<ObstaclePoint> points_;  ///< from the robot at the scan's end
  std::optional<Time> end_;            ///< of the scan
};

}  // namespace dynslam
