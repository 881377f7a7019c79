// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <vector>

#include <Eigen/Geometry>

#include "base/pose2.h"
#include "base/scan.h"
#include "base/time.h"
#include "grid/free_space.h"
#include "slam/slam_config.h"

/// The steps between the lidar's raw beams and rays that can be drawn (thesis 4.1.1). Each is a function of
/// its input.
namespace dynslam {

/// A ray as measured from the lidar at its own time, after clamping.
struct Ray {
  float angle_rad = 0.0F;  ///< lidar frame, already turned over for a lidar mounted upside down
  float range_m = 0.0F;
  float time_s = 0.0F;  ///< after the scan's stamp
  bool hit = false;     ///< false: cut at the trusted range
};

/// A scan put right: all rays as the robot would have seen them from where it was at one moment.
struct CorrectedScan {
  Time reference;  ///< that moment: the middle of the scan
  Pose2 robot_T_lidar;
  std::vector<RayEnd> ends_lidar;  ///< lidar frame at the reference time, in order of bearing
  double beam_step_rad = 0.0;      ///< mean angle between beams; 0 when there are fewer than two
};

/// Where the robot was at a time, as seen from where it was at the reference time: reference_T_robot(t).
using MotionInScan = std::function<Pose2(Time)>;

/// Roll and pitch at a time: turns the robot's axes into level ones of the same heading.
using TiltInScan = std::function<Eigen::Quaterniond(Time)>;

/// What a lidar on a robot of this height should see: neither floor nor what the robot passes under, metres
/// above the floor.
struct HeightBand {
  double low_m = 0.05;
  double high_m = 0.60;
};

/// Keeps what is believed: no rays shorter than `min_range_m`, none without a valid measurement. Rays over
/// `trusted_range_m` are cut to it and lose their end point. A ray from which nothing came back says nothing:
/// a black cupboard does the same.
std::vector<Ray> clamp_pass(const Scan& scan, const SlamConfig& config);

/// Lays the rays of a robot that rolls and pitches down on the level plane, each with the tilt of its own
/// time. A ray that leaves the height band is cut to where it leaves it and loses its end point: what it met
/// is the floor, or above the robot (thesis 6.4).
void level_pass(const Scan& scan, const TiltInScan& tilt, const HeightBand& band, std::vector<Ray>& rays);

/// The time a scan's corrected rays refer to: halfway between its first and last beam.
Time reference_time(const Scan& scan);

/// Mean angle between neighbouring beams, radians.
double beam_step(const Scan& scan);

/// Egomotion correction: each ray from the pose the lidar had at the ray's own time (thesis, equations 4.1
/// and 4.2, with the linear motion the thesis left out).
CorrectedScan egomotion_pass(const Scan& scan, const std::vector<Ray>& rays, const MotionInScan& motion);

/// Drops rays that go through a surface which the rays on both sides show closed: reflections and crosstalk.
/// What a ray saw through a gap that is wider than two beams stays.
void stray_ray_pass(CorrectedScan& scan);

}  // namespace dynslam
