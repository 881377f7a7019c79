// SPDX-License-Identifier: MIT
#include "sim/disturbance.h"

#include <charconv>
#include <limits>
#include <sstream>
#include <vector>

#include "base/angles.h"
#include "base/error.h"
#include "base/number_text.h"

namespace dynslam {
namespace {

constexpr double kMost_s = 1e6, kMost_m = 1000.0, kMost_deg = 360.0;

[[noreturn]] void refuse(const std::string& text, const std::string& why) {
  throw InputError("'" + text + "': " + why);
}

std::vector<std::string> parts_of(const std::string& text) {
  std::vector<std::string> parts;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, ':');) parts.push_back(part);
  return parts;
}

double number_in(const std::string& text, const std::string& part, double least, double most) {
  double number = 0.0;
  const auto read = std::from_chars(part.data(), part.data() + part.size(), number);
  const bool is_number = read.ec == std::errc() && read.ptr == part.data() + part.size();
  if (!is_number || !(number >= least && number <= most)) {
    refuse(text, "'" + part + "' is no number from " + shortest_text(least) + " to " + shortest_text(most));
  }
  return number;
}

}  // namespace

ScheduledFault parse_fault(const std::string& text) {
  const std::vector<std::string> parts = parts_of(text);
  if (parts.size() < 3 || parts.size() > 4) refuse(text, "a fault is DEVICE:KIND:FROM[:UNTIL]");
  const auto device = sim_device_of(parts[0]);
  if (!device) refuse(text, "devices are lidar, imu, motors, camera, pins");
  const auto kind = fault_kind_of(parts[1]);
  if (!kind) refuse(text, "kinds are unplugged, frozen, silent, delayed, nan, infinite, mirrored");
  if (!can_have(*device, *kind)) refuse(text, "this device cannot fail in this way");
  ScheduledFault fault{*device, *kind, number_in(text, parts[2], 0.0, kMost_s),
                       std::numeric_limits<double>::max()};
  if (parts.size() == 4) fault.until_s = number_in(text, parts[3], 0.0, kMost_s);
  if (fault.until_s <= fault.at_s) refuse(text, "it must end after it begins");
  return fault;
}

ScheduledKick parse_kick(const std::string& text) {
  const std::vector<std::string> parts = parts_of(text);
  if (parts.size() < 3 || parts.size() > 4) refuse(text, "a kick is AT:FORWARD:LEFT[:TURN]");
  ScheduledKick kick;
  kick.at_s = number_in(text, parts[0], 0.0, kMost_s);
  kick.robot_T_new.x = number_in(text, parts[1], -kMost_m, kMost_m);
  kick.robot_T_new.y = number_in(text, parts[2], -kMost_m, kMost_m);
  if (parts.size() == 4) kick.robot_T_new.yaw = radians(number_in(text, parts[3], -kMost_deg, kMost_deg));
  return kick;
}

}  // namespace dynslam
