// SPDX-License-Identifier: MIT
#include "io/ros_messages.h"

#include <cmath>

#include "io/cdr.h"
#include "io/scan_limits.h"

namespace dynslam {
namespace {

constexpr double kMaxScanDuration = 100.0;  // seconds
constexpr double kUnitTolerance = 0.1;
constexpr double kRounding = 1e-14;  // nearer to one than this, normalizing only stirs the last bits

RosHeader read_header(CdrReader& cdr) {
  const auto seconds = cdr.number<std::int32_t>();
  const auto nanoseconds = cdr.number<std::uint32_t>();
  const Time stamp(std::chrono::seconds(seconds) + std::chrono::nanoseconds(nanoseconds));
  return {stamp, cdr.text()};
}

Eigen::Vector3d read_vector(CdrReader& cdr) {
  const auto x = cdr.number<double>(), y = cdr.number<double>(), z = cdr.number<double>();
  return {x, y, z};
}

Eigen::Quaterniond read_quaternion(CdrReader& cdr) {
  const auto x = cdr.number<double>(), y = cdr.number<double>(), z = cdr.number<double>();
  return {cdr.number<double>(), x, y, z};
}

bool is_near_unit(const Eigen::Quaterniond& q) { return std::abs(q.norm() - 1.0) <= kUnitTolerance; }

/// A limit that a driver left unset (zero, NaN) does not limit.
float usable_max(float range_max_m) {
  return range_max_m > 0.0F ? range_max_m : std::numeric_limits<float>::infinity();
}

}  // namespace

std::optional<RosMessage<Scan>> decode_laser_scan(Bytes bytes) {
  CdrReader cdr(bytes);
  RosMessage<Scan> scan{read_header(cdr), {}};
  const double angle_min = cdr.number<float>();
  cdr.number<float>();  // angle_max: follows from the others, and drivers disagree on whether it is the last
                        // beam
  const double step = cdr.number<float>();
  // Where it is zero, some drivers still fill in scan_time, which may be the time of a turn or between two
  // scans: a guess from it would bend scans that were never bent.
  const double time_step = cdr.number<float>();
  cdr.number<float>();  // scan_time
  const float range_min = cdr.number<float>();
  const float range_max = usable_max(cdr.number<float>());
  const std::vector<float> ranges = cdr.floats(kMaxBeams);
  const double duration = time_step * static_cast<double>(ranges.size());
  if (!cdr.ok() || !is_plausible_fan(angle_min, step, ranges.size())) return std::nullopt;
  if (!(time_step >= 0.0 && duration < kMaxScanDuration)) return std::nullopt;

  scan.value.stamp = scan.header.stamp;
  scan.value.beams.reserve(ranges.size());
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    const auto n = static_cast<double>(i);
    const float range = clean_range(ranges[i], range_min > 0.0F ? range_min : 0.0F, range_max);
    scan.value.beams.push_back(
        {static_cast<float>(angle_min + n * step), range, static_cast<float>(n * time_step)});
  }
  return scan;
}

RosMessage<Eigen::Quaterniond> decode_imu(Bytes bytes, ImuFault& fault) {
  CdrReader cdr(bytes);
  RosMessage<Eigen::Quaterniond> imu{read_header(cdr), read_quaternion(cdr)};
  const auto covariance = cdr.number<double>();
  fault = ImuFault::kNone;
  if (!cdr.ok()) {
    fault = ImuFault::kUndecodable;
  } else if (covariance == -1.0) {
    fault = ImuFault::kNoOrientation;  // the message's own way to say that the field means nothing
  } else if (!is_near_unit(imu.value)) {
    fault = ImuFault::kBadQuaternion;
  } else if (std::abs(imu.value.squaredNorm() - 1.0) > kRounding) {
    imu.value.normalize();
  }
  return imu;
}

std::string_view name_of(ImuFault fault) {
  switch (fault) {
    case ImuFault::kUndecodable:
      return "imu.bad";
    case ImuFault::kNoOrientation:
      return "imu.no_orientation";
    case ImuFault::kBadQuaternion:
      return "imu.bad_quaternion";
    case ImuFault::kNone:
      break;
  }
  return "";
}

std::optional<RosMessage<Pose2>> decode_odometry(Bytes bytes) {
  CdrReader cdr(bytes);
  RosMessage<Pose2> odometry{read_header(cdr), {}};
  cdr.text();  // child_frame_id
  const Eigen::Vector3d position = read_vector(cdr);
  const Eigen::Quaterniond q = read_quaternion(cdr);
  if (!cdr.ok() || !position.allFinite() || !is_near_unit(q)) return std::nullopt;
  odometry.value = {position.x(), position.y(), yaw_of(q.normalized())};
  return odometry;
}

bool decode_transforms(Bytes bytes, TfTree& tree) {
  CdrReader cdr(bytes);
  const auto count = cdr.number<std::uint32_t>();
  bool all_taken = cdr.ok();
  for (std::uint32_t i = 0; i < count && cdr.ok(); ++i) {
    const std::string_view parent = read_header(cdr).frame_id;
    const std::string_view child = cdr.text();
    const Eigen::Vector3d translation = read_vector(cdr);
    const Eigen::Quaterniond rotation = read_quaternion(cdr);
    if (!cdr.ok() || !tree.add(parent, child, translation, rotation)) all_taken = false;
  }
  return all_taken;
}

}  // namespace dynslam
